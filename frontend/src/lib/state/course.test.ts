import fc from 'fast-check';
import { afterEach, expect, test, vi } from 'vitest';
import type { RunRecord } from '#lib/contract.ts';
import { alarm } from '#lib/testing/view.ts';
import { courseOf, coursesOf, readAlarms, readCourse, since } from './course.ts';

afterEach(() => vi.unstubAllGlobals());

function record(number: number, kind: string, content: object): RunRecord {
	return { number, time: number, kind, content: content as RunRecord['content'], plan_message: null, hash: '' };
}

test('a course begins with what a start has, and goes on with what ticks have measured and changed', () => {
	const records = [
		record(5, 'ticked', { measured: { 'robot.at': 'home' } }),
		record(4, 'ticked', { changes: { bolt: 'tight' }, measured: { 'robot.at': 'kit' } }),
		record(3, 'ticked', { started: ['robot.move'] }),
		record(2, 'ticked', { measured: { 'robot.at': 'kit' } }),
		record(1, 'begun', { values: { bolt: 'empty', 'robot.at': null } })
	];
	expect(courseOf(records, 'robot.at').map(({ at, value }) => [at, value])).toEqual([
		[1, null],
		[2, 'kit'],
		[5, 'home']
	]);
	expect(courseOf(records, 'bolt').map(({ at, value }) => [at, value])).toEqual([
		[1, 'empty'],
		[4, 'tight']
	]);
	expect(courseOf(records, 'toString')).toEqual([]);
});

test('what a person has done is told, also where the value stays', () => {
	const records = [
		record(4, 'force-released', { what: { name: 'gripper' } }),
		record(3, 'forced', { what: { name: 'gripper', value: true } }),
		record(2, 'corrected', { what: { values: { bolt: 'tight' } }, changes: { bolt: 'tight' } }),
		record(1, 'begun', { values: { bolt: 'empty', gripper: true } })
	];
	expect(courseOf(records, 'bolt').map(({ act }) => act)).toEqual([null, 'corrected']);
	expect(courseOf(records, 'gripper').map(({ value, act }) => [value, act])).toEqual([
		[true, null],
		[true, 'forced'],
		[true, 'force-released']
	]);
});

test('what is in sight begins with what was so then, and leaves nothing out', () => {
	const times = fc.uniqueArray(fc.integer({ min: 0, max: 100 })).map((all) => all.sort((a, b) => a - b));
	fc.assert(
		fc.property(times, fc.integer({ min: -1, max: 101 }), (all, from) => {
			const shown = since(
				all.map((at) => ({ at, value: at, act: null })),
				from
			).map(({ at }) => at);
			expect(shown.filter((at) => at >= from)).toEqual(all.filter((at) => at >= from));
			expect(shown.filter((at) => at < from)).toEqual(all.filter((at) => at < from).slice(-1));
		})
	);
});

test('it is read page by page as far back as is asked for, and what is too much is said', async () => {
	const asked: (string | null)[] = [];
	const pages = (until: number): void => {
		asked.length = 0;
		vi.stubGlobal('fetch', (address: string) => {
			const query = new URL(address, 'http://station').searchParams;
			asked.push(query.get('before'));
			const before = Number(query.get('before') ?? 10_001);
			const records = Array.from({ length: 200 }, (_, place) => record(before - 1 - place, 'ticked', { changes: { bolt: (before - place) % 2 } }));
			return Promise.resolve(Response.json({ records, next: before - 200 > until ? before - 200 : null }));
		});
	};
	pages(0);
	expect(await readCourse('bolt', 9700)).toMatchObject({ known: null });
	expect(asked).toEqual([null, '9801']);
	expect(await readCourse('bolt', 0)).toMatchObject({ known: 8801 });
	pages(9700);
	expect(await readCourse('bolt', 0)).toMatchObject({ known: null });
});

test('the alarms that came to a resource are read from the journal, and no others', async () => {
	const turn = (number: number, event: string, resources: string[]): RunRecord =>
		record(number, 'alarm', { ...alarm({ resources }), alarm: `silent:${String(number)}`, event });
	const records = [
		turn(9, 'ended', ['robot']),
		turn(8, 'came', ['robot', 'tool']),
		turn(7, 'came', ['camera']),
		turn(6, 'came again', ['robot']),
		turn(2, 'came', ['robot'])
	];
	const asked: URL[] = [];
	vi.stubGlobal('fetch', (address: string) => {
		asked.push(new URL(address, 'http://station'));
		return Promise.resolve(Response.json({ records, next: null }));
	});
	expect((await readAlarms('robot', 5))?.map(({ at }) => at)).toEqual([8, 6]);
	expect(asked.map(({ searchParams }) => searchParams.get('kinds'))).toEqual(['alarm']);
	// What belongs to no resource has no alarms, and nothing is asked for.
	expect(await readAlarms(null, 5)).toEqual([]);
	expect(asked).toHaveLength(1);
	vi.stubGlobal('fetch', () => Promise.reject(new TypeError('no way there')));
	expect(await readAlarms('robot', 5)).toBeNull();
});

test('courses of all begin with what was so, and leave out what is not asked for', () => {
	const records = [
		record(13, 'ticked', { measured: { at: null }, changes: { other: 1 } }),
		record(12, 'ticked', { started: ['robot.move'] }),
		record(11, 'ticked', { measured: { at: 'kit' }, changes: { bolt: 'tight' } }),
		record(9, 'ticked', { measured: { at: 'far' } })
	];
	expect([...coursesOf({ at: 'home', bolt: 'empty' }, 10, records)]).toEqual([
		['at', [{ at: 10, value: 'home' }, { at: 11, value: 'kit' }, { at: 13, value: null }]],
		['bolt', [{ at: 10, value: 'empty' }, { at: 11, value: 'tight' }]]
	]);
});
