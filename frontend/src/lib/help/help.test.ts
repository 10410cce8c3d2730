import { describe, expect, test } from 'vitest';
import { LANGUAGES, type Language } from '#lib/text/languages.ts';
import { HELPED, type HelpedPage } from './helped.ts';
import { PICTURES } from './pictures.ts';

const languages = Object.keys(LANGUAGES) as Language[];
const pages = Object.keys(PICTURES) as HelpedPage[];
const texts = new Map(await Promise.all(languages.map(async (each) => [each, await HELPED[each]()] as const)));
const english = texts.get('en')!;

describe.each(languages)('the help in %s', (language) => {
	const { pages: helped, keys } = texts.get(language)!;

	test.each(pages)('is short and whole on the page %s', (page) => {
		const { about, how } = helped[page];
		expect(about).toMatch(/^\p{Lu}.*\.$/u);
		expect(how.length).toBeGreaterThanOrEqual(2);
		expect(how.length).toBeLessThan(10);
		for (const line of how) expect(line).toMatch(/^\p{Lu}.*\.$/u);
		expect(new Set(how).size).toBe(how.length);
	});

	test('has the same lines as in English, and is not in English', () => {
		expect(Object.keys(helped).sort()).toEqual(Object.keys(english.pages).sort());
		expect(keys.all).toHaveLength(english.keys.all.length);
		expect(keys.conditions).toHaveLength(english.keys.conditions.length);
		for (const page of pages) {
			expect(helped[page].how, page).toHaveLength(english.pages[page].how.length);
			if (language !== 'en') for (const line of helped[page].how) expect(english.pages[page].how).not.toContain(line);
		}
	});
});

test.each(pages)('each number in the picture of the page %s is a line, and is seen whole', (page) => {
	const { places } = PICTURES[page];
	expect(places.length).toBeGreaterThan(1);
	expect(places.length).toBeLessThanOrEqual(english.pages[page].how.length);
	for (const [at, [x, y]] of places.entries()) {
		expect(x).toBeGreaterThanOrEqual(7);
		expect(x).toBeLessThanOrEqual(233);
		expect(y).toBeGreaterThanOrEqual(7);
		expect(y).toBeLessThanOrEqual(105);
		for (const [otherX, otherY] of places.slice(at + 1)) expect(Math.hypot(x - otherX, y - otherY)).toBeGreaterThan(13);
	}
});
