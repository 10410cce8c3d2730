import { expect, test } from 'vitest';
import { briefly } from './brief.ts';

const told = (...titles: [entry: string, title: string][]): string[] => {
	const operations = Object.fromEntries(titles.map(([entry], index) => [`${entry}(${index})`, { entry }]));
	const names = new Map(titles.map(([entry, title], index) => [`${entry}(${index})`, title]));
	return [...briefly(operations, (name) => names.get(name) ?? name).values()];
};

test('several of a kind keep their first word and what tells them apart; one alone keeps its title', () => {
	expect(told(['place', 'Place the bolts of pair 1'], ['place', 'Place the bolts of pair 2'])).toEqual(['Place pair 1', 'Place pair 2']);
	expect(told(['place', 'Place the bolts of pair 1'], ['mount', 'Mount the frame on the engine'])).toEqual(['Place the bolts of pair 1', 'Mount the frame on the engine']);
	expect(told(['go', 'Go to A'], ['go', 'Go to B'], ['same', 'Do it'], ['same', 'Do it'])).toEqual(['Go to A', 'Go to B', 'Do it', 'Do it']);
	expect(told(['load', 'Load part A into the rack'], ['load', 'Load part B into the rack'])).toEqual(['Load part A into the rack', 'Load part B into the rack']);
});
