import { describe, expect, test } from 'vitest';
import type { Comparison, PartDifference } from '#lib/contract.ts';
import { differencesIn, rowsOf, type Row } from './rows.ts';

const EMPTY: Comparison = {
	text: { 'station.yaml': '' },
	parts: [],
	behaviour: [],
	plans: [],
	undecided: [],
	unplanned: [],
	guards: [14, 14],
	states: 41208,
	doing: '',
	doing_message: null,
	seconds: 2.3,
	obstacle: null,
	obstacle_message: null
};
const TITLES = { ability: (name: string): string => `the ${name}`, operation: (name: string): string => `to ${name}` };
const NONE = (): readonly number[] => [];
const seconds = (n: number): { id: string; arguments: Record<string, number> } => ({ id: 'compare.seconds', arguments: { seconds: n } });
type Changed = PartDifference['parts'][number];
const PLAIN = { before_message: null, after_message: null, before_expanded: null, after_expanded: null, added: [], dropped: [] };

function limit(before: number | null, after: number | null): Changed {
	const said = (n: number | null): string | null => (n === null ? null : `${n} s`);
	const told = (n: number | null): Changed['before_message'] => (n === null ? null : seconds(n));
	return { ...PLAIN, part: 'must finish within', before: said(before), after: said(after), before_message: told(before), after_message: told(after) };
}

function ability(...parts: Changed[]): PartDifference {
	return { kind: 'ability', name: 'tool.run', titles: [{ id: 'step.so', arguments: { so: 'Run the tool' } }], over: null, members: ['tool.run'], state: 'changed', parts };
}

const only = (result: Partial<Comparison>, measured = NONE): Row => rowsOf({ ...EMPTY, ...result }, TITLES, measured)[0] as Row;

describe('a time limit', () => {
	test('is told with the values, and by how much it is late earlier', () => {
		const row = only({ parts: [ability(limit(40, 12))] });
		expect(row).toMatchObject({ about: 'limit', tag: 'changed', lead: 'Run the tool counts as late after', was: '40 s', is: '12 s' });
		expect(row.says.join(' ')).toContain('28 s earlier');
		expect(only({ parts: [ability(limit(12, 40))] }).says.join(' ')).toContain('28 s later');
	});

	test('is measured against the runs there were', () => {
		const said = only({ parts: [ability(limit(40, 12))] }, () => [3.04, 13, 5]).says.join(' ');
		expect(said).toContain('In its last 3 runs it took 3 to 13 s.');
		expect(said).toContain('1 of these 3 would have been late.');
		expect(only({ parts: [ability(limit(40, 12))] }, () => [3]).says.join(' ')).not.toContain('late.');
	});

	test('that is new or gone says who is told', () => {
		expect(only({ parts: [ability(limit(null, 5))] })).toMatchObject({ tag: 'new', lead: 'Run the tool has a time limit now:', was: null, is: '5 s' });
		const gone = only({ parts: [ability(limit(5, null))] });
		expect(gone).toMatchObject({ tag: 'gone', was: '5 s', is: null });
		expect(gone.says).toEqual(['Nobody is told any more when it takes long.']);
	});
});

test('a condition is told by what is new in it and what is gone, and stands in full behind that', () => {
	const told = (text: string): Changed['added'][number] => ({ text, sentence: { id: 'step.so', arguments: { so: `it is ${text}` } } });
	const changed = { ...PLAIN, part: 'enabled', before: 'a and b', after: 'a and c', added: [told('c')], dropped: [told('b')] };
	const row = only({ parts: [ability(changed)] });
	expect(row).toMatchObject({ about: 'condition', lead: 'Run the tool may start on other conditions', was: null, is: null });
	expect(row.says).toEqual(['Also needed now: it is c.', 'No longer needed: it is b.']);
	expect(row.properties).toEqual([changed]);
});

test('parts that are new or gone are one row each, with all that they are made of', () => {
	const part = { ...ability(limit(null, 5)), state: 'new' as const };
	expect(only({ parts: [part] })).toMatchObject({ tag: 'new', lead: 'New ability: Run the tool', properties: part.parts });
	expect(only({ parts: [{ ...part, state: 'gone' }] })).toMatchObject({ tag: 'gone', lead: 'The ability Run the tool is gone' });
});

test('what somebody has changed stands before what the supervisor makes of it', () => {
	const added = ability({ ...PLAIN, part: 'added by the supervisor', before: null, after: 'x' });
	const rows = rowsOf({ ...EMPTY, parts: [{ ...added, members: ['other'] }, ability(limit(40, 12))] }, TITLES, NONE);
	expect(rows.map(({ about }) => about)).toEqual(['limit', 'proof', 'proof']);
	expect(differencesIn(rows)).toBe(2);
});

test('where an ability can start is told only where that is proven, with a run where there is one', () => {
	const rows = rowsOf(
		{ ...EMPTY, behaviour: [{ ability: 'tool.run', gains: true, gained: ['a', 'b'], loses: null, lost: null }] },
		TITLES,
		NONE
	);
	expect(rows).toHaveLength(1);
	expect(rows[0]).toMatchObject({ tag: 'new', lead: 'the tool.run can start where it could not', says: ['It is so after 2 starts.'], runs: [['the a', 'the b']] });
	const lost = only({ behaviour: [{ ability: 'tool.run', gains: false, gained: null, loses: true, lost: null }] });
	expect(lost).toMatchObject({ tag: 'changed', runs: [] });
	expect(lost.says).toEqual(['Such a state is reached; no short run there was found.']);
});

describe('at the end', () => {
	test('it says that nothing differs where that is proven', () => {
		const row = only({});
		expect(row).toMatchObject({ tag: 'same', lead: 'What may start where: no difference' });
		expect(row.says.join(' ')).toContain('restricts 14 abilities as before');
	});

	test('it says what is not decided, and never that it is the same then', () => {
		const rows = rowsOf({ ...EMPTY, undecided: ['a', 'b'] }, TITLES, NONE);
		expect(rows.map(({ tag }) => tag)).toEqual(['open']);
		expect(rows[0]?.says[0]).toContain('the a, the b');
		const open = rowsOf({ ...EMPTY, unplanned: ['x'], behaviour: [{ ability: 'a', gains: true, gained: [], loses: false, lost: null }] }, TITLES, NONE);
		expect(open.map(({ tag }) => tag)).toEqual(['new', 'open']);
	});

	test('it says nothing before it is known, or where no file differs', () => {
		expect(rowsOf({ ...EMPTY, behaviour: null, undecided: null }, TITLES, NONE)).toEqual([]);
		expect(rowsOf({ ...EMPTY, text: {} }, TITLES, NONE)).toEqual([]);
	});
});
