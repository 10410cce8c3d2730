import { expect, test } from 'vitest';
import { alarm, operation, PLAN, view } from '#lib/testing/view.ts';
import { aboutOf } from './about.ts';

const STATION = view({ resources: { robot: { title: 'Robot', online: true, awaited_topics: [] } } });

test('an alarm leads to its topics, and to those of its resources that are there', () => {
	const silent = alarm({ resources: ['robot', 'gone'], topics: ['/robot/state'] });
	expect(aboutOf(silent, STATION)).toEqual({ resources: ['robot'], topics: ['/robot/state'], restart: true });
});

test('what a person has to decide leads to Restart, and so does a device that is not as it should be', () => {
	expect(aboutOf(alarm({ ended: 1 }), STATION).restart).toBe(false);
	expect(aboutOf(alarm({ priority: 'low' }), STATION).restart).toBe(false);
	expect(aboutOf(alarm({ group: 'recovery' }), STATION).restart).toBe(true);
	expect(aboutOf(alarm({ ended: 1 }), { ...STATION, standing: 'stopped' }).restart).toBe(true);
	const stuck = { ...STATION, plan: { ...PLAN, status: 'none' as const }, operations: { paint: operation({ active: true }) } };
	expect(aboutOf(alarm({ ended: 1 }), stuck).restart).toBe(true);
	expect(aboutOf(alarm({ group: 'system' }), { ...STATION, standing: 'stopped' }).restart).toBe(false);
});
