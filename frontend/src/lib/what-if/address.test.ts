import fc from 'fast-check';
import { expect, test } from 'vitest';
import { cutIn, spaceOf, withoutCut } from '#lib/state-space/address.ts';
import { VIEWS, besideView, viewIn } from './address.ts';

const queryOf = (address: string): URLSearchParams => new URL(address, 'http://station.test').searchParams;

test('a view that is chosen is read from the address again, with what the others began with', () => {
	const rest = fc.uniqueArray(fc.tuple(fc.constantFrom('record', 'scenario', 'cut'), fc.string()), { selector: ([key]) => key });
	fc.assert(
		fc.property(rest, fc.array(fc.constantFrom(...VIEWS), { minLength: 1 }), (kept, views) => {
			let query = new URLSearchParams(kept);
			for (const view of views) {
				query = queryOf(besideView(query, view));
				expect(viewIn(query)).toBe(view);
			}
			query.delete('view');
			expect([...query]).toEqual([...new URLSearchParams(kept)]);
		})
	);
});

test.each([
	['', 'steps'],
	['record=7', 'simulation'],
	['scenario=a_round', 'simulation'],
	['simulation', 'simulation'],
	['space=on&cut=robot.move', 'space'],
	['record=7&view=steps', 'steps'],
	['view=nothing', 'steps']
])('an address from elsewhere, `%s`, leads to %s', (query, view) => {
	expect(viewIn(new URLSearchParams(query))).toBe(view);
});

test('where starts are kept back stands in the address until all is looked at again', () => {
	const query = queryOf(spaceOf(['robot.move', 'robot.lift']));
	expect(viewIn(query)).toBe('space');
	expect(cutIn(query)).toEqual(['robot.move', 'robot.lift']);
	const after = queryOf(withoutCut(query));
	expect(viewIn(after)).toBe('space');
	expect(cutIn(after)).toEqual([]);
});
