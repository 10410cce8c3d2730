import { describe, expect, test } from 'vitest';
import { en as ofPages } from './en.ts';
import findings from './en/findings.json';
import refusals from './en/front.json';
import messages from './en/messages.json';
import { sv } from './sv.ts';

/** With what the station says in English itself. */
const en = { ...ofPages, messages: { ...refusals, ...messages, ...findings } };

/** Every text by where it stands; what takes arguments is there too. */
function flat(texts: object, path = ''): [string, unknown][] {
	return Object.entries(texts).flatMap(([key, value]: [string, unknown]) =>
		typeof value === 'object' && value !== null ? flat(value, `${path}${key}.`) : [[path + key, value]]
	);
}

describe('the Swedish catalogue', () => {
	test('has the texts of the English one, and no others', () => {
		const places = (texts: object): string[] => flat(texts).map(([place]) => place).sort();
		expect(places(sv)).toEqual(places(en));
	});

	test('leaves nothing empty', () => {
		for (const [place, text] of flat(sv)) if (typeof text === 'string') expect(text.trim(), place).not.toBe('');
	});
});
