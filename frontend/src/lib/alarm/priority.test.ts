import { expect, test } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { byUrgency, isNew, setAside } from './priority.ts';

const names = (alarms: [string, unknown][]): string[] => alarms.map(([name]) => name);

test('alarms stand by priority, then what nobody has seen, then the newest, and what is over comes last', () => {
	const alarms = {
		low: alarm({ priority: 'low' }),
		'high, older': alarm({ priority: 'high', since: 10 }),
		'high, seen': alarm({ priority: 'high', state: 'acknowledged', since: 30 }),
		'high, over': alarm({ priority: 'high', state: 'returned', since: 20, ended: 25 })
	};
	expect(names(byUrgency(alarms))).toEqual(['high, older', 'high, seen', 'low', 'high, over']);
});

test('what is shelved or out of service stands apart', () => {
	const alarms = { a: alarm({ state: 'shelved' }), b: alarm(), c: alarm({ state: 'out-of-service', priority: 'high' }) };
	expect(names(byUrgency(alarms))).toEqual(['b']);
	expect(names(setAside(alarms))).toEqual(['c', 'a']);
});

test('an alarm is new until somebody has seen it, even when its cause has gone', () => {
	const states = ['unacknowledged', 'returned', 'acknowledged', 'shelved', 'out-of-service'] as const;
	expect(states.map((state) => isNew(alarm({ state })))).toEqual([true, true, false, false, false]);
});
