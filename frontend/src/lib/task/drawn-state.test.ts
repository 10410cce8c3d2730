import { expect, test } from 'vitest';
import { asAddress, withState } from './drawn-state.ts';

const SVG = '<svg xmlns="http://www.w3.org/2000/svg"><g id="pair_1"/><g id="pair_2"/><g id="pair_3"/></svg>';

test('each part of a drawing has the value of the variable with its name as index', () => {
	const values = { 'engine.bolts[pair_1]': { value: 'tightened' }, 'bolts[pair_2]': { value: 'placed' }, 'bolts[pair_3]': { value: null }, other: { value: true } };
	const drawn = withState(SVG, values) ?? '';
	expect(drawn).toContain('<g id="pair_1" data-bolts="tightened"/>');
	expect(drawn).toContain('<g id="pair_2" data-bolts="placed"/>');
	// What is unknown is not said to be anything.
	expect(drawn).toContain('<g id="pair_3"/>');
});

test('a drawing of which no part is called so stays as it is', () => {
	expect(withState(SVG, { 'doors[left]': { value: 'open' } })).toBeNull();
	expect(withState(SVG, { 'bolts[pair]': { value: 'placed' } })).toBeNull();
});

test('the part that is marked stays marked', () => {
	expect(asAddress('<svg/>', 'pair_1')).toBe('data:image/svg+xml,%3Csvg%2F%3E#pair_1');
});
