import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { ticksOf } from '#lib/axis/ticks.ts';
import type { PlanStep } from '#lib/contract.ts';
import { step } from '#lib/testing/view.ts';
import { cutAt, endOf, hasBegun, laneHeight, lateness, layOut, MOST_MARKS, timesOf, type Block, type Lane } from './lanes.ts';

const NOW = 1000;
const ROOM = { words: 3, mark: 0.5 };
const RESOURCES = ['robot', 'nutrunner', 'operator'];
const resource = fc.constantFrom(...RESOURCES, 'agv');
const seconds = fc.integer({ min: 0, max: 200 }).map((tenths) => tenths / 10);
const past = fc.array(
	fc.record({ resource, ago: seconds, lasted: fc.option(seconds), expected: fc.option(seconds) }),
	{ maxLength: 16 }
);
const future = fc.array(fc.record({ resource, after: seconds, takes: seconds }), { maxLength: 10 });

/** Steps as the server lists them: those that have begun, then those ahead in the order of their start. */
const steps = fc.tuple(past, future, seconds).map(([begun, ahead, late]): PlanStep[] => {
	let start = NOW - late;
	return [
		...begun.map(({ resource, ago, lasted, expected }, k) => {
			const started = NOW - ago;
			const ended = lasted === null ? null : Math.min(NOW, started + lasted);
			const expected_end = ended !== null || expected === null ? null : started + expected;
			return step(`past${k}`, resource, 0, { status: ended === null ? 'running' : 'done', started, ended, expected_end });
		}),
		...ahead.map(({ resource, after, takes }, k) => {
			start += after / 10;
			const status = k ? 'planned' : 'next';
			return step(`ahead${k}`, resource, k, { status, expected_start: start, expected_end: start + takes });
		})
	];
});

function blocksOf(lanes: readonly Lane[]): Block[] {
	return lanes.flatMap((lane) => [...lane.blocks]);
}

const drawn = (list: readonly PlanStep[]): Lane[] => layOut(list, RESOURCES, NOW, ROOM);

/** Sums of tenths are not exact. */
const NEARLY = 1e-6;

describe('the lanes of any plan', () => {
	test('hold every step once, in the lane of its resource', () => {
		fc.assert(
			fc.property(steps, (list) => {
				const lanes = drawn(list);
				const ids = (all: readonly PlanStep[]): string[] => all.map((each) => each.id).sort();
				expect(ids(blocksOf(lanes).map((block) => block.step))).toEqual(ids(list));
				for (const lane of lanes) for (const block of lane.blocks) expect(block.step.resource).toBe(lane.resource);
				expect(lanes.map((lane) => lane.resource).slice(0, RESOURCES.length)).toEqual(RESOURCES);
			})
		);
	});

	test('never draw two blocks of a row over each other, nor one too narrow for its mark', () => {
		fc.assert(
			fc.property(steps, (list) => {
				for (const lane of drawn(list)) {
					for (const row of Array.from({ length: lane.rows }, (_, index) => index)) {
						const blocks = lane.blocks.filter((block) => block.row === row).sort((a, b) => a.from - b.from);
						for (const [index, block] of blocks.entries()) {
							expect(block.to - block.from).toBeGreaterThanOrEqual(ROOM.mark - NEARLY);
							expect(block.from).toBeGreaterThanOrEqual((blocks[index - 1]?.to ?? -Infinity) - NEARLY);
						}
					}
					expect(Math.max(0, ...lane.blocks.map((block) => block.row))).toBeLessThan(lane.rows);
				}
			})
		);
	});

	test('keep what is over before the present, and what is planned after it', () => {
		fc.assert(
			fc.property(steps, (list) => {
				for (const { step, from, to } of blocksOf(drawn(list))) {
					if (!hasBegun(step)) expect(from).toBeGreaterThanOrEqual(0);
					else if (step.ended === null) expect(to).toBeGreaterThanOrEqual(0);
					else expect(to).toBeLessThanOrEqual(NEARLY);
				}
			})
		);
	});

	test('cover the time that each step takes', () => {
		fc.assert(
			fc.property(steps, (list) => {
				const late = lateness(list, NOW);
				for (const { step, from, to } of blocksOf(drawn(list))) {
					const { start, end } = timesOf(step, NOW, late);
					if (hasBegun(step)) expect(from).toBeLessThanOrEqual(start);
					expect(to - from).toBeGreaterThanOrEqual(end - start - NEARLY);
				}
			})
		);
	});

	test('keep what is ahead in its order within a row, as it will start', () => {
		fc.assert(
			fc.property(steps, (list) => {
				for (const lane of drawn(list)) {
					const order = list.filter((each) => each.resource === lane.resource && !hasBegun(each));
					for (let row = 0; row < lane.rows; row++) {
						const mine = lane.blocks.filter((block) => block.row === row && !hasBegun(block.step));
						const places = mine.map((block) => order.indexOf(block.step));
						expect(places).toEqual([...places].sort((a, b) => a - b));
					}
				}
			})
		);
	});

	test('let everything glide alike while nothing happens and nothing is late', () => {
		const plan = [
			step('done', 'robot', 0, { status: 'done', started: NOW - 20, ended: NOW - 12 }),
			step('next', 'robot', 1, { status: 'next', expected_start: NOW + 10, expected_end: NOW + 14 })
		];
		const places = (now: number): number[] => blocksOf(layOut(plan, [], now, ROOM)).map((block) => block.from + now);
		expect(places(NOW + 5)).toEqual(places(NOW));
	});
});

test('what is late is expected at once, and what follows as much later', () => {
	const plan = [
		step('next', 'robot', 0, { status: 'next', expected_start: NOW - 30, expected_end: NOW - 28 }),
		step('then', 'nutrunner', 1, { expected_start: NOW - 28, expected_end: NOW - 20 })
	];
	expect(blocksOf(layOut(plan, [], NOW, ROOM)).map(({ from }) => from)).toEqual([0, 2]);
	expect(endOf(layOut(plan, [], NOW, ROOM))).toBe(10);
});

test('what runs is drawn to where it is expected to end, and to the present where that has passed', () => {
	const running = (expected_end: number): PlanStep =>
		step('run', 'nutrunner', 0, { status: 'running', started: NOW - 6, expected_end });
	const end = (list: PlanStep[]): number | undefined => blocksOf(drawn(list))[0]?.to;
	expect(end([running(NOW + 2)])).toBe(2);
	expect(end([running(NOW - 2)])).toBe(0);
});

test('an axis of any length has few marks, and what is later than it is counted', () => {
	fc.assert(
		fc.property(steps, fc.integer({ min: 1, max: 40 }), (list, limit) => {
			const lanes = drawn(list);
			const { lanes: cut, later } = cutAt(lanes, limit);
			expect(endOf(cut)).toBeLessThanOrEqual(limit);
			expect(blocksOf(cut).length + later).toBe(blocksOf(lanes).length);
			for (const block of blocksOf(cut)) expect(block.from).toBeLessThan(limit);
		})
	);
	for (const length of [10, 200, 1506, 16_000, 1e6]) expect(ticksOf(-60, length, MOST_MARKS).length).toBeLessThanOrEqual(MOST_MARKS + 1);
});

test('lanes share the room, and those of several rows take theirs from the others', () => {
	expect(laneHeight([1.25, 1.25], 5)).toBe(2.5);
	expect(laneHeight([1.25, 3.75, 1.25], 6.75)).toBe(1.5);
	expect(laneHeight([2.5, 2.5, 1.25], 7.5)).toBe(2.5);
	expect(laneHeight([3, 3], 5)).toBe(0);
	expect(laneHeight([], 5)).toBe(0);
	fc.assert(
		fc.property(fc.array(fc.integer({ min: 1, max: 6 }), { minLength: 1, maxLength: 12 }), fc.integer({ min: 0, max: 60 }), (needs, room) => {
			const height = laneHeight(needs, room);
			const sum = needs.reduce((all, need) => all + Math.max(height, need), 0);
			if (height > 0) expect(sum).toBeCloseTo(room);
			else expect(sum).toBeGreaterThanOrEqual(room);
		})
	);
});
