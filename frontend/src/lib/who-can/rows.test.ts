import { expect, test } from 'vitest';
import type { WhoCan } from '#lib/contract.ts';
import { alarm } from '#lib/testing/view.ts';
import { absentUntold } from './rows.ts';

const ROBOT = { of: 'resource', name: 'robot', title: 'Robot UR10', why: 'silent' } as const;
const found = (...absent: WhoCan['absent']): WhoCan => ({ absent, nobody: [], others: [] });

test('that a device is not heard is said once: by the alarm that stands beside it, or else here', () => {
	expect(absentUntold(found(ROBOT), undefined)).toEqual([ROBOT]);
	expect(absentUntold(found(ROBOT), alarm({ resources: ['robot'] }))).toEqual([]);
	// An alarm of something else, or one that is over, does not say it.
	expect(absentUntold(found(ROBOT), alarm({ resources: ['camera'] }))).toEqual([ROBOT]);
	expect(absentUntold(found(ROBOT), alarm({ resources: ['robot'], ended: 9 }))).toEqual([ROBOT]);
	// What is out of service has a list of its own.
	expect(absentUntold(found({ ...ROBOT, why: 'out of service' }), undefined)).toEqual([]);
});
