import fc from 'fast-check';
import { expect, test } from 'vitest';
import { layOut, lengthAhead } from '#lib/plan/lanes.ts';
import { stepsOf } from './preview-lanes.ts';

const step = fc
	.record({
		tick: fc.nat(9),
		start: fc.float({ min: 0, max: 500, noNaN: true }),
		lasts: fc.float({ min: 0, max: 100, noNaN: true }),
		ability: fc.string(),
		title: fc.string(),
		resource: fc.constantFrom('robot', 'tool', 'operator'),
		human: fc.boolean(),
		restart: fc.boolean(),
		moves: fc.boolean()
	})
	.map(({ lasts, ...rest }) => ({ ...rest, end: rest.start + lasts }));
/** As a plan has them: in the order of their starts. */
const steps = fc.array(step).map((all) => all.sort((a, b) => a.start - b.start));

test('each step has one bar, at its own resource, when it is expected', () => {
	fc.assert(
		fc.property(steps, (all) => {
			const lanes = layOut(stepsOf({ steps: all }), [], 0, { words: 0, mark: 0 });
			const blocks = lanes.flatMap(({ resource, blocks }) => blocks.map((block) => ({ ...block, resource })));
			expect(blocks.map((block) => Number(block.step.id)).sort((a, b) => a - b)).toEqual(all.map((_, number) => number));
			for (const { step: drawn, resource, from, until } of blocks) {
				const meant = all[Number(drawn.id)];
				expect([drawn.title, resource, from]).toEqual([meant?.title, meant?.resource, meant?.start]);
				expect(until).toBeCloseTo(meant?.end ?? 0, 6);
			}
		})
	);
});

test('all of it is in sight, also the words of what begins last', () => {
	fc.assert(
		fc.property(steps, fc.float({ min: 0.5, max: 1, noNaN: true }), (all, words) => {
			const length = lengthAhead(stepsOf({ steps: all }), words);
			for (const { start, end } of all) {
				expect(end).toBeLessThanOrEqual(length);
				expect(start).toBeLessThanOrEqual(length * words + 1e-6);
			}
		})
	);
});

test('what is first in the plan is next', () => {
	const all = fc.sample(step, 3);
	expect(stepsOf({ steps: all }).map(({ status }) => status)).toEqual(['next', 'planned', 'planned']);
});
