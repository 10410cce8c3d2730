import { expect, test } from 'vitest';
import { bestOf } from './languages.ts';

test.each([
	[['sv-FI', 'en'], 'sv'],
	[['SV'], 'sv'],
	[['fi', 'sv'], 'sv'],
	[['en-US', 'sv'], 'en'],
	[['constructor'], 'en'],
	[[], 'en']
])('whoever reads %j gets %s', (wanted, language) => {
	expect(bestOf(wanted)).toBe(language);
});
