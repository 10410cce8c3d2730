import { expect, it } from 'vitest';
import type { MimicText, MimicTrack, StationView, Variable } from '#lib/contract.ts';
import { alarm, estimate } from '#lib/testing/view.ts';
import { inLanguage } from '#lib/text/text.svelte.ts';
import { alarmsOf, holds, levelOf, lookOf, saidOf, sentTo, whereabouts, worst } from './live.ts';

const variables = (values: Record<string, Variable['value']>): StationView['variables'] =>
	Object.fromEntries(Object.entries(values).map(([name, value]) => [name, estimate({ value })]));
const TRACK: MimicTrack = {
	position: 'at',
	target: 'to',
	previous: 'last',
	stops: ['home', 'above', 'pair'].map((value) => ({ value, title: {}, x: 0, y: 0, label: 'above', room: 9, branch: false })),
	ways: [
		['home', 'above'],
		['above', 'pair']
	]
};

it('tests hold, fail, or are open where a value is unknown', () => {
	const tests = [
		{ variable: 'tool', values: ['a', 'b'] },
		{ variable: 'locked', values: [true] }
	];
	expect(holds(tests, variables({ tool: 'b', locked: true }))).toBe(true);
	expect(holds(tests, variables({ tool: 'c', locked: null }))).toBe(false);
	expect(holds(tests, variables({ tool: 'a', locked: null }))).toBeNull();
	expect(holds(tests, variables({ tool: 'a' }))).toBeNull();
	expect(holds([], variables({}))).toBe(true);
});

it('says the first text that holds, in the language of the page, with values', () => {
	const texts: MimicText[] = [
		{ text: { en: 'Turns', sv: 'Roterar' }, when: [{ variable: 'runs', values: [true] }] },
		{ text: { '': 'Battery {battery}, {other}' }, when: [] }
	];
	expect(saidOf(texts, variables({ runs: true }), 'sv')).toBe('Roterar');
	expect(saidOf(texts, variables({ runs: null, battery: 3 }), 'sv')).toBe('Battery 3, ?');
	expect(saidOf([], variables({}), 'en')).toBe('');
	expect(inLanguage({ en: 'a' }, 'sv')).toBe('a');
	expect(inLanguage({ sv: 'b' }, 'en')).toBe('b');
});

it('shows a thing where it is, between two stops, or in doubt', () => {
	expect(whereabouts(TRACK, variables({ at: 'home', to: 'above' }), null)).toEqual({ from: 'home', to: 'home', kind: 'there' });
	expect(whereabouts(TRACK, variables({ at: 'between', to: 'pair', last: 'above' }), 'home')).toEqual({ from: 'above', to: 'pair', kind: 'moving' });
	expect(whereabouts(TRACK, variables({ at: 'between', to: 'above', last: null }), 'home')).toEqual({ from: 'home', to: 'above', kind: 'moving' });
	expect(whereabouts(TRACK, variables({ at: 'between', to: 'pair', last: null }), null)).toEqual({ from: 'above', to: 'pair', kind: 'moving' });
	expect(whereabouts(TRACK, variables({ at: null, to: 'above', last: 'home' }), null)).toEqual({ from: 'home', to: 'home', kind: 'doubt' });
	expect(whereabouts(TRACK, variables({ at: null, to: null, last: null }), null)).toBeNull();
	// Where it stood when it was heard last is told also to who has not looked on.
	const silent = { ...variables({ to: 'pair', last: 'home' }), at: estimate({ value: null, last_known: 'above' }) };
	expect(whereabouts(TRACK, silent, null)).toEqual({ from: 'above', to: 'above', kind: 'doubt' });
	const onItsWay = { ...silent, last: estimate({ value: null, last_known: 'above' }), at: estimate({ value: null, last_known: 'between' }) };
	expect(whereabouts(TRACK, onItsWay, null)).toEqual({ from: 'above', to: 'pair', kind: 'doubt' });
	// It is drawn at no stop at which it was never seen.
	expect(whereabouts(TRACK, variables({ at: null, to: 'above', last: null }), null)).toBeNull();
	expect(whereabouts(TRACK, variables({ at: null, to: 'above', last: null }), 'home')).toEqual({ from: 'home', to: 'home', kind: 'doubt' });
});

it('knows where it was sent as long as it is not there', () => {
	expect(sentTo(TRACK, variables({ at: 'home', to: 'above' }))).toBe('above');
	expect(sentTo(TRACK, variables({ at: 'above', to: 'above' }))).toBeNull();
	expect(sentTo(TRACK, variables({ at: 'home', to: null }))).toBeNull();
});

it('shows a part as its value looks, and what is unknown as doubt', () => {
	const part = { variable: 'bolt', title: {}, label: '1', label_x: 0, label_y: 0, marks: [], size: 9, looks: { empty: 'empty', tight: 'done', true: 'placed' }, titles: {} } as const;
	const look = (value: Variable['value']) => lookOf({ ...part, marks: [] }, variables({ bolt: value }));
	expect([look('tight'), look('empty'), look(true), look(null), look('other')]).toEqual(['done', 'empty', 'placed', 'doubt', 'doubt']);
});

it('lights up with the most urgent alarm that lasts and that people are told of', () => {
	const alarms = {
		low: alarm({ priority: 'low' }),
		high: alarm({ priority: 'high' }),
		over: alarm({ priority: 'high', ended: 5 }),
		other: alarm({ priority: 'high', resources: ['tool'] }),
		shelved: alarm({ priority: 'high', state: 'shelved' })
	};
	expect(alarmsOf(alarms, 'robot').map(([key]) => key)).toEqual(['high', 'low']);
	expect(worst(alarmsOf(alarms, 'robot'))).toBe('high');
	expect(worst(alarmsOf(alarms, 'dock'))).toBeNull();
	expect(alarmsOf(alarms, null)).toEqual([]);
});

it('draws a level between its lowest and its highest value', () => {
	const level = { variable: 'battery', lowest: 1, highest: 5 };
	expect(levelOf({ level }, variables({ battery: 3 }))).toBe(0.5);
	expect(levelOf({ level }, variables({ battery: null }))).toBeNull();
	expect(levelOf({ level: null }, variables({}))).toBeNull();
});
