import { readdirSync } from 'node:fs';
import { expect, test } from 'vitest';
import { examples as en } from '#lib/text/en/examples.ts';
import { examples as sv } from '#lib/text/sv/examples.ts';

test('of each station of the repository it is said what it shows, in every language', () => {
	const names = readdirSync(new URL('../../../../models', import.meta.url)).sort();
	for (const texts of [en, sv]) expect(Object.keys(texts.shows).sort()).toEqual(names);
});
