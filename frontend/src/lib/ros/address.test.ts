import fc from 'fast-check';
import { expect, test } from 'vitest';
import { LISTS, addressOf, lookedAt } from './address.ts';

test('what is looked at is read from its address again', () => {
	const name = fc.option(fc.string({ minLength: 1 }));
	const looks = fc.record({
		topic: name,
		resource: name,
		text: fc.string(),
		show: fc.constantFrom('all', 'station', 'wrong'),
		list: fc.constantFrom(...LISTS)
	});
	fc.assert(
		fc.property(looks, (looked) => {
			const url = new URL(addressOf(looked), 'http://station.test');
			expect(url.pathname).toBe('/ros');
			expect(lookedAt(url.searchParams)).toEqual(looked);
		})
	);
});
