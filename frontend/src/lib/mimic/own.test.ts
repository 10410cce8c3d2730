import { expect, it } from 'vitest';
import type { MimicBound, MimicDrawing, Variable } from '#lib/contract.ts';
import { estimate } from '#lib/testing/view.ts';
import { attributeOf, looksOf, paintedOf } from './own.ts';

const element = (inside: number | null, attributes: Record<string, string>): MimicDrawing['elements'][number] => ({
	inside,
	name: 'path',
	attributes,
	text: ''
});
const BOUND: MimicBound = {
	element: 'lamp',
	visible: [{ variable: 'there', values: [true] }],
	role: 'high',
	when: [{ variable: 'hot', values: [true] }],
	text: { en: 'at {at}', sv: 'vid {at}' }
};
const variables = (values: Record<string, Variable['value']>) =>
	Object.fromEntries(Object.entries(values).map(([name, value]) => [name, estimate({ value })]));

it('knows what is painted, and takes from around what an element does not say', () => {
	const painted = paintedOf([
		element(null, {}),
		element(null, { fill: 'none', stroke: 'red' }),
		element(1, {}),
		element(2, { fill: 'blue', stroke: 'none' })
	]);
	expect(painted).toEqual([
		{ fill: true, stroke: false },
		{ fill: false, stroke: true },
		{ fill: false, stroke: true },
		{ fill: true, stroke: false }
	]);
});

it('keeps the names of a drawing apart from those of others', () => {
	expect(attributeOf('id', 'a', 'c1')).toBe('c1-a');
	expect(attributeOf('href', '#a', 'c1')).toBe('#c1-a');
	expect(attributeOf('fill', 'url(#a)', 'c1')).toBe('url(#c1-a)');
	expect(attributeOf('fill', '#a0a', 'c1')).toBe('#a0a');
});

it('shows an element, its colour and its text as the values say, and what is unknown as doubt', () => {
	expect(looksOf(BOUND, variables({ there: true, hot: true, at: 'far_home' }), 'sv')).toEqual({ shown: 'yes', role: 'high', text: 'vid far home' });
	expect(looksOf(BOUND, variables({ there: false, hot: null, at: 3 }), 'en')).toEqual({ shown: 'no', role: null, text: 'at 3' });
	expect(looksOf({ ...BOUND, text: {} }, variables({ there: null, hot: false }), 'en')).toEqual({ shown: 'doubt', role: null, text: null });
	expect(looksOf({ ...BOUND, visible: [], when: [] }, variables({ at: null }), 'en')).toEqual({ shown: 'yes', role: 'high', text: 'at ?' });
});
