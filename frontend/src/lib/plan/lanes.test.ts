import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { PlanStep } from '#lib/contract.ts';
import { step } from '#lib/testing/view.ts';
import { hasBegun, layOut, shownSteps, type Block, type Chart } from './lanes.ts';

const RESOURCES = ['robot', 'nutrunner', 'operator'];
const resource = fc.constantFrom(...RESOURCES);
const past = fc.array(
	fc.record({
		resource,
		// Few instants, so that several steps start together, and ticks of plans that were replaced long ago.
		started: fc.nat(15),
		lasted: fc.option(fc.nat(20)),
		tick: fc.nat(50)
	}),
	{ maxLength: 16 }
);
const future = fc.array(fc.record({ resource, tick: fc.nat(12) }), { maxLength: 8 });

/** Steps as the server lists them: those that have begun, then those ahead in the order of their start. */
const steps = fc.tuple(past, future).map(([begun, ahead]): PlanStep[] => [
	...begun.map(({ resource, started, lasted, tick }, k) =>
		step(`past${k}`, resource, tick, {
			status: lasted === null ? 'running' : 'done',
			started,
			ended: lasted === null ? null : started + lasted
		})
	),
	...ahead.map(({ resource, tick }, k) => step(`ahead${k}`, resource, tick, { status: k ? 'planned' : 'next' }))
]);

const columns = fc.integer({ min: 1, max: 10 });

function blocksOf(chart: Chart): Block[] {
	return chart.lanes.flatMap((lane) => [...lane.blocks]);
}

describe('the lanes of any plan', () => {
	test('hold every shown step once, in the lane of its resource', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const chart = layOut(list, RESOURCES, columns);
				const shown = shownSteps(list, columns);
				expect(
					blocksOf(chart)
						.map((block) => block.step.id)
						.sort()
				).toEqual(shown.map((s) => s.id).sort());
				for (const lane of chart.lanes)
					for (const block of lane.blocks) expect(block.step.resource).toBe(lane.resource);
			})
		);
	});

	test('never draw two blocks over each other, nor one outside the columns', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const chart = layOut(list, RESOURCES, columns);
				for (const lane of chart.lanes) {
					const cells = lane.blocks.flatMap(({ row, column, span }) =>
						Array.from({ length: span }, (_, k) => `${row}/${column + k}`)
					);
					expect(new Set(cells).size).toBe(cells.length);
					for (const { row, column, span } of lane.blocks) {
						expect(row).toBeLessThan(lane.rows);
						expect(column + span).toBeLessThanOrEqual(chart.begun.length + chart.ahead);
					}
				}
			})
		);
	});

	test('keep what has begun before the present and what has not behind it, whatever ticks the steps had', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const chart = layOut(list, RESOURCES, columns);
				for (const { step, column, span } of blocksOf(chart)) {
					if (hasBegun(step)) expect(column + span).toBeLessThanOrEqual(chart.begun.length);
					else expect(column).toBeGreaterThanOrEqual(chart.begun.length);
				}
			})
		);
	});

	test('put what started together into one column, and what started earlier to the left', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const chart = layOut(list, RESOURCES, columns);
				expect(chart.begun).toEqual([...new Set(chart.begun)].sort((a, b) => a - b));
				for (const { step, column, continued } of blocksOf(chart)) {
					if (!hasBegun(step)) continue;
					if (continued) expect(step.started).toBeLessThan(chart.begun[0] ?? -Infinity);
					else expect(chart.begun[column]).toBe(step.started);
				}
			})
		);
	});

	test('promise nothing: what is ahead fills one column, never to the left of a start before it', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const drawn = new Map(blocksOf(layOut(list, RESOURCES, columns)).map((block) => [block.step.id, block]));
				const ahead = list.filter((s) => !hasBegun(s)).map((s) => drawn.get(s.id));
				ahead.reduce((before, block) => {
					expect(block?.span).toBe(1);
					expect(block?.column).toBeGreaterThanOrEqual(before?.column ?? 0);
					return block;
				}, undefined);
			})
		);
	});

	test('show no more of the past than can be read, and everything that still runs', () => {
		fc.assert(
			fc.property(steps, columns, (list, columns) => {
				const chart = layOut(list, RESOURCES, columns);
				expect(chart.begun.length).toBeLessThanOrEqual(columns);
				const drawn = new Set(blocksOf(chart).map((block) => block.step.id));
				for (const { id, status } of list) if (status !== 'done') expect(drawn).toContain(id);
			})
		);
	});
});

test('a tool that runs while the robot makes two moves is drawn over both, of whichever plans they were', () => {
	const chart = layOut(
		[
			step('run', 'nutrunner', 5, { status: 'running', started: 10 }),
			step('above', 'robot', 5, { status: 'done', started: 10, ended: 12 }),
			step('down', 'robot', 1, { status: 'running', started: 12 }),
			step('up', 'robot', 4, { status: 'next' }),
			step('again', 'nutrunner', 4),
			step('over', 'robot', 6)
		],
		['robot', 'nutrunner', 'operator']
	);
	expect(chart.begun).toEqual([10, 12]);
	expect(chart.ahead).toBe(2);
	const placed = chart.lanes.map((lane) => lane.blocks.map(({ step, column, span }) => [step.id, column, span]));
	expect(placed).toEqual([
		[
			['above', 0, 1],
			['down', 1, 1],
			['up', 2, 1],
			['over', 3, 1]
		],
		[
			['run', 0, 2],
			['again', 2, 1]
		],
		[]
	]);
});

test('a step that was pulled forward is drawn before those that start after it, not at the tick it once had', () => {
	const chart = layOut([step('pulled', 'robot', 6, { status: 'next' }), step('task', 'operator', 2)], []);
	expect(chart.ahead).toBe(1);
	expect(chart.lanes.flatMap((lane) => lane.blocks.map((block) => block.column))).toEqual([0, 0]);
});
