import fc from 'fast-check';
import { expect, test } from 'vitest';
import { LEAST, lanesOf } from './preview-lanes.ts';

const step = fc
	.record({
		tick: fc.nat(9),
		start: fc.float({ min: 0, max: 500, noNaN: true }),
		lasts: fc.float({ min: 0, max: 100, noNaN: true }),
		ability: fc.string(),
		title: fc.string(),
		resource: fc.constantFrom('robot', 'tool', 'operator'),
		human: fc.boolean(),
		restart: fc.boolean()
	})
	.map(({ lasts, ...rest }) => ({ ...rest, end: rest.start + lasts }));
/** As a plan has them: in the order of their starts. */
const steps = fc.array(step).map((all) => all.sort((a, b) => a.start - b.start));

test('each step has one bar, at its own resource, within the picture and large enough to be seen', () => {
	fc.assert(
		fc.property(steps, (all) => {
			const lanes = lanesOf({ steps: all });
			const bars = lanes.flatMap(({ resource, rows }) => rows.flat().map((bar) => ({ ...bar, resource })));
			expect(bars.map(({ number }) => number).sort((a, b) => a - b)).toEqual(all.map((_, number) => number));
			for (const { step, number, from, to, resource } of bars) {
				expect([step, resource]).toEqual([all[number], step.resource]);
				expect(from).toBeGreaterThanOrEqual(0);
				expect(to).toBeLessThanOrEqual(1);
				expect(to - from).toBeGreaterThanOrEqual(LEAST - 1e-9);
			}
			expect(new Set(lanes.map(({ resource }) => resource)).size).toBe(lanes.length);
		})
	);
});

test('bars of one row lie one after the other', () => {
	fc.assert(
		fc.property(steps, (all) => {
			for (const row of lanesOf({ steps: all }).flatMap(({ rows }) => rows))
				for (const [place, bar] of row.entries()) expect(bar.from).toBeGreaterThanOrEqual(row[place - 1]?.to ?? 0);
		})
	);
});
