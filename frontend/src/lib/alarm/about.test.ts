import { expect, test } from 'vitest';
import { alarm, operation, PLAN, view } from '#lib/testing/view.ts';
import { aboutOf } from './about.ts';

const STATION = view({ resources: { robot: { title: 'Robot', online: true, awaited_topics: [] } } });

test('an alarm leads to its topics, and to those of its resources that are there', () => {
	const silent = alarm({ resources: ['robot', 'gone'], topics: ['/robot/state'] });
	expect(aboutOf(silent, STATION)).toEqual({ resources: ['robot'], topics: ['/robot/state'], restart: false });
});

test('what a person has to decide leads to Restart, and so does a device by which the station is unsafe or has no plan', () => {
	expect(aboutOf(alarm({ group: 'recovery' }), STATION).restart).toBe(true);
	expect(aboutOf(alarm(), { ...STATION, standing: 'stopped' }).restart).toBe(true);
	const stuck = { ...STATION, plan: { ...PLAN, status: 'none' as const }, operations: { paint: operation({ active: true }) } };
	expect(aboutOf(alarm(), stuck).restart).toBe(true);
	expect(aboutOf(alarm({ group: 'system' }), { ...STATION, standing: 'stopped' }).restart).toBe(false);
});
