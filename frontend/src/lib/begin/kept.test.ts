import { expect, test } from 'vitest';
import { Kept, type Shelf } from './kept.ts';
import { blank, type Sketch } from './sketch.ts';

const shelf = (): Shelf & { readonly all: Map<string, string> } => {
	const all = new Map<string, string>();
	return { all, getItem: (key) => all.get(key) ?? null, setItem: (key, value) => void all.set(key, value), removeItem: (key) => void all.delete(key) };
};
const titled = (title: string): Sketch => ({ ...blank(), title });
const shared = shelf();
const tab = (browser = shared, own = shelf()): Kept => new Kept('cell', 'erik', () => browser, () => own);

test('what one tab writes the other one reads, and goes on from', () => {
	const browser = shelf();
	const [one, other] = [tab(browser), tab(browser)];
	expect([one.read(), other.read()]).toEqual([null, null]);
	expect(one.keep(titled('A'))).toBe(true);
	expect(other.elsewhere()).toEqual({ sketch: titled('A'), newer: true });
	expect(other.read()).toEqual(titled('A'));
	expect(other.elsewhere()).toBeNull();
	expect(other.keep(titled('AB'))).toBe(true);
	expect(one.elsewhere()).toEqual({ sketch: titled('AB'), newer: true });
});

test('a tab that has not read what another one wrote overwrites nothing, and loses nothing', () => {
	const [browser, own] = [shelf(), shelf()];
	const [one, other] = [tab(browser), tab(browser, own)];
	one.read();
	other.read();
	one.keep(titled('A'));
	expect(other.keep(titled('B'))).toBe(false);
	other.setAside(titled('B'));
	expect(tab(browser).read()).toEqual(titled('A'));
	expect(tab(browser, own).aside()).toEqual(titled('B'));
	other.force(titled('B'));
	expect(tab(browser).read()).toEqual(titled('B'));
	expect(tab(browser, own).aside()).toBeNull();
	expect(one.elsewhere()).toEqual({ sketch: titled('B'), newer: true });
});

test('that nothing is kept any more is told, too', () => {
	const browser = shelf();
	const [one, other] = [tab(browser), tab(browser)];
	one.keep(titled('A'));
	other.read();
	expect(other.keep(null)).toBe(true);
	expect(one.elsewhere()).toEqual({ sketch: null, newer: true });
});

test('what was kept before is read, and a browser that keeps nothing is no obstacle', () => {
	const browser = shelf();
	browser.all.set('begin:cell:erik', JSON.stringify(titled('of before')));
	expect(tab(browser).read()).toEqual(titled('of before'));
	const none = new Kept('cell', 'erik', () => { throw new Error('denied'); }, () => { throw new Error('denied'); });
	expect(none.read()).toBeNull();
	expect(none.keep(titled('A'))).toBe(true);
	expect(none.keep(titled('AB'))).toBe(true);
	expect(none.aside()).toBeNull();
});
