import { expect, test } from 'vitest';
import type { JobResponse } from '#lib/contract.ts';
import { namesOf } from '#lib/history/names.ts';
import { deviationsOf } from './deviations.ts';

type Deviation = JobResponse['deviations'][number];
const names = namesOf(null);

function deviation(record: number, kind: string, content: Deviation['content']): Deviation {
	return { record, time: record * 10, time_at: '', kind, content };
}

test('a plan that was made anew is none, and an alarm is one, however often it is told of', () => {
	const alarm = { alarm: 'overdue:agv', text: 'The AGV is late. It has not arrived', priority: 'medium', kind: 'overdue', resources: ['agv'] };
	const deviations = [
		deviation(1, 'replanned', { reason: 'a shorter one was found' }),
		deviation(2, 'alarm', { ...alarm, event: 'came' }),
		deviation(3, 'alarm', { ...alarm, event: 'acknowledged' }),
		deviation(4, 'alarm', { ...alarm, event: 'gone' })
	];
	expect(deviationsOf({ deviations }, names)).toMatchObject([{ record: 2, time: 20, what: 'The AGV is late' }]);
});

test('what was given up and what was taken out of service are told in words', () => {
	const deviations = [
		deviation(5, 'given-up', { abilities: ['robot.move'] }),
		deviation(6, 'service-changed', { of: 'resource', name: 'agv', in_service: false, by: 'Eva', why: 'A wheel is flat' })
	];
	const found = deviationsOf({ deviations }, names);
	expect(found[0]?.what).toContain('robot.move');
	expect(found[1]?.what).toContain('agv');
	expect(found[1]?.about).toContain('A wheel is flat');
});
