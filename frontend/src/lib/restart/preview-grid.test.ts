import fc from 'fast-check';
import { expect, test } from 'vitest';
import { gridOf } from './preview-grid.ts';

const step = fc.record({
	tick: fc.nat(9),
	ability: fc.string(),
	title: fc.string(),
	resource: fc.constantFrom('robot', 'tool', 'operator'),
	human: fc.boolean(),
	restart: fc.boolean()
});

test('lanes hold each step once, in its own tick and at its own resource', () => {
	fc.assert(
		fc.property(fc.array(step), (steps) => {
			const { ticks, lanes } = gridOf({ ticks: 10, steps, minimal_ticks: true, minimal_starts: true });
			const found = lanes.flatMap(({ resource, cells }) =>
				cells.flatMap((cell, index) => cell.map((each) => ({ each, resource, tick: ticks[index] })))
			);
			expect(found).toHaveLength(steps.length);
			for (const { each, resource, tick } of found) expect([resource, tick]).toEqual([each.resource, each.tick]);
			expect(new Set(found.map(({ each }) => each))).toEqual(new Set(steps));
		})
	);
});
