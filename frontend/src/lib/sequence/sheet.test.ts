import { expect, test } from 'vitest';
import type { OperationLink } from '#lib/contract.ts';
import { drawnOf, isBefore, isChance, sheetOf } from './sheet.ts';

type Kind = OperationLink['reasons'][number]['kind'];

function link(before: string, after: string, kind: Kind = 'work_master', again = false): OperationLink {
	return { before, after, again, reasons: [{ kind, name: 'engine', condition: null }] };
}

function columns(lanes: Record<string, string | null>, links: OperationLink[]): Record<string, number> {
	const { spots } = sheetOf(Object.fromEntries(Object.entries(lanes).map(([name, lane]) => [name, { lane }])), links);
	return Object.fromEntries([...spots].map(([name, { column }]) => [name, column]));
}

test('what comes later is further to the right, and what could be earlier stands beside what it is done for', () => {
	const lanes = { fetch: 'agv', tool: 'robot', mount: 'robot', first: 'operator', second: 'operator', tighten: 'robot', release: 'line' };
	const links = [
		link('fetch', 'mount'),
		link('mount', 'first'),
		link('mount', 'second'),
		link('first', 'tighten'),
		link('tighten', 'release'),
		link('second', 'release'),
		link('tool', 'mount')
	];
	expect(columns(lanes, links)).toEqual({ fetch: 0, tool: 0, mount: 1, first: 2, tighten: 3, second: 3, release: 4 });
});

test('lanes are in the order in which they are needed; in one column of a lane operations lie below one another', () => {
	const operations = { last: { lane: 'line' }, one: { lane: 'agv' }, two: { lane: 'agv' }, nobody: { lane: null } };
	const { lanes, spots, columns } = sheetOf(operations, [link('one', 'last'), link('two', 'last'), link('one', 'nobody')]);
	expect(lanes).toEqual([
		{ name: 'agv', top: 0, rows: 2 },
		{ name: 'line', top: 2, rows: 1 },
		{ name: '', top: 3, rows: 1 }
	]);
	expect([spots.get('one')?.row, spots.get('two')?.row, columns]).toEqual([0, 1, 2]);
});

test('one of several that will do is enough, and what was done in the round before moves nothing', () => {
	const lanes = { a: 'x', b: 'x', c: 'x', tool: 'y' };
	const links = [link('a', 'b'), link('b', 'c'), link('a', 'tool', 'chance'), link('c', 'tool', 'chance'), link('tool', 'a', 'condition', true)];
	expect(columns(lanes, links)).toEqual({ a: 0, b: 1, c: 2, tool: 1 });
	expect(isChance(link('a', 'tool', 'chance'))).toBe(true);
	const sheet = sheetOf(Object.fromEntries(Object.entries(lanes).map(([name, lane]) => [name, { lane }])), links);
	const drawn = (chosen: string | null): string[] => drawnOf(links, sheet, chosen).map(({ before, after }) => `${before}${after}`);
	expect(drawn(null)).toEqual(['ab', 'bc', 'atool', 'toola']);
	expect(drawn('c')).toEqual(['ab', 'bc', 'atool', 'ctool', 'toola']);
});

test('none of them is laid out as well', () => {
	expect(sheetOf({}, [])).toEqual({ spots: new Map(), lanes: [], columns: 0 });
});

test('it is known what surely comes before what', () => {
	const links = [link('a', 'b'), link('b', 'c'), link('c', 'd', 'chance'), link('c', 'a', 'condition', true)];
	expect([isBefore('a', 'c', links), isBefore('c', 'a', links), isBefore('a', 'd', links)]).toEqual([true, false, false]);
});
