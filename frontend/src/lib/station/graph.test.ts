import { describe, expect, test } from 'vitest';
import type { ModelGraph, ModelThing, ModelTie } from '#lib/contract.ts';
import { addressOf, lookedAt } from './address.ts';
import { bandsOf, countsIn, shortName, spokenName } from './bands.ts';
import { findingsAt } from './findings.ts';
import { reached, tiedTo, wholeOf, type Manner, type Whole } from './graph.ts';
import { looseEnds } from './loose.ts';
import { next } from './neighbour.ts';
import { foundBy, usesOf } from './uses.ts';

/** A thing such as `variable:robot.pose measured`. */
function thing(text: string, line: number): ModelThing {
	const [id = '', section = null] = text.split(' ');
	const [kind = '', name = ''] = id.split(':');
	const own = ['variable', 'ability', 'flow'].includes(kind) && name.includes('.') ? (name.split('.')[0] ?? null) : null;
	const resource = kind === 'resource' ? name : (own ?? (kind === 'topic' ? 'robot' : null));
	const layer = { work_master: 3, operation: 2, specification: 2, station: 2, ability: 1 }[kind] ?? (section === 'estimated' ? 1 : 0);
	return { id, kind, name, title: null, layer, standing: 'declared', resource, section, within: null, file: 'a.yaml', line, column: 1 };
}

/** A tie such as `operation:go goal variable:robot.pose`. */
function tie(things: readonly ModelThing[], text: string): ModelTie {
	const [by, manner, used] = text.split(' ');
	const index = (id: string | undefined): number => things.findIndex((each) => each.id === id);
	return { thing: index(used), by: index(by), manner: manner as Manner, at: '', file: 'a.yaml', line: 1, column: 1, written: true };
}

function graph(things: readonly string[], ties: readonly string[], change: (made: ModelThing) => ModelThing = (made) => made): Whole {
	const made = things.map((each, index) => change(thing(each, index + 1)));
	const found: ModelGraph = { number: 1, things: made, ties: ties.map((each) => tie(made, each)), unread: [] };
	return wholeOf(found);
}

const THINGS = [
	'station:s', 'work_master:job', 'operation:go', 'resource:robot', 'ability:robot.move', 'ability:robot.idle',
	'variable:robot.pose measured', 'variable:robot.target output', 'variable:robot.spare output', 'variable:count estimated',
	'topic:/state', 'topic:/command', 'topic:/other', 'enumeration:pose', 'enumeration:colour'
];
const TIES = [
	'work_master:job runs operation:go', 'operation:go goal variable:robot.pose', 'operation:go names resource:robot',
	'ability:robot.move effect variable:robot.pose', 'ability:robot.move commands variable:robot.target',
	'ability:robot.move guard variable:robot.pose', 'topic:/state feeds variable:robot.pose', 'topic:/state reads variable:robot.pose',
	'topic:/command sends variable:robot.target', 'variable:robot.pose ranges enumeration:pose', 'topic:/command example variable:robot.target'
];
const WHOLE = graph(THINGS, TIES);
const at = (id: string): number => WHOLE.byId.get(id)?.index ?? -1;
const ids = (found: Iterable<number>): string[] => [...found].map((index) => WHOLE.things[index]?.id ?? '').sort();

describe('what is tied to what', () => {
	test('from the goal of an operation it is four steps to the topic that carries it out', () => {
		const { down, up } = tiedTo(WHOLE, at('operation:go'), 4);
		const steps = (id: string): number | undefined => down.get(at(id))?.steps;
		expect(steps('variable:robot.pose')).toBe(1);
		expect(steps('ability:robot.move')).toBe(2);
		expect(steps('topic:/state')).toBe(2);
		expect(steps('variable:robot.target')).toBe(3);
		expect(steps('topic:/command')).toBe(4);
		expect(ids(up.keys())).toEqual(['work_master:job']);
		expect(ids(tiedTo(WHOLE, at('operation:go'), 1).down.keys())).toEqual(['variable:robot.pose']);
	});

	test('up is down the other way', () => {
		for (const { index } of WHOLE.things)
			for (const other of reached(WHOLE.down, [index]).keys())
				expect(reached(WHOLE.up, [other]).has(index), `${index} ${other}`).toBe(true);
	});

	test('a topic that feeds a variable does not rest on it', () => {
		expect(ids(tiedTo(WHOLE, at('topic:/state'), 9).down.keys())).toEqual([]);
		expect(ids(tiedTo(WHOLE, at('topic:/state'), 9).up.keys())).toContain('work_master:job');
	});

	test('who names a resource is above it', () => {
		const { up } = tiedTo(WHOLE, at('resource:robot'), 2);
		expect(ids(up.keys())).toEqual(['operation:go', 'work_master:job']);
	});

	test('a value is chosen as the one it is, and stands with its enumeration', () => {
		const whole = graph(
			[...THINGS, 'value:pose.home'],
			[...TIES, 'operation:go names value:pose.home'],
			(made) => (made.kind === 'value' ? { ...made, within: THINGS.indexOf('enumeration:pose') } : made)
		);
		const value = whole.byId.get('value:pose.home')?.index ?? -1;
		const { chosen, up } = tiedTo(whole, value, 1);
		expect(whole.things[chosen]?.id).toBe('enumeration:pose');
		expect([...up.keys()].map((index) => whole.things[index]?.id)).toEqual(['operation:go']);
	});

	test('in words it is grouped by the manner, with what it is for', () => {
		const { up, down } = usesOf(WHOLE, at('variable:robot.target'));
		expect(up.map(({ manner, isUsed }) => [manner, isUsed])).toEqual([['commands', true], ['example', true]]);
		expect(down.map(({ manner, isUsed }) => [manner, isUsed])).toEqual([['sends', true]]);
		const pose = usesOf(WHOLE, at('variable:robot.pose'));
		expect(pose.up.map(({ manner }) => manner)).toEqual(['goal', 'guard', 'reads']);
		expect(pose.down.map(({ manner }) => manner)).toEqual(['effect', 'feeds', 'ranges']);
		expect(usesOf(WHOLE, at('operation:go')).down.map(({ manner }) => manner)).toEqual(['goal']);
	});
});

test('what is tied to nothing is found, each with why', () => {
	const found = Object.fromEntries([...looseEnds(WHOLE)].map(([index, why]) => [WHOLE.things[index]?.id, why]));
	expect(found).toEqual({
		'ability:robot.idle': 'unneeded',
		'variable:robot.spare': 'unsent',
		'variable:count': 'unwritten',
		'topic:/other': 'unneeded',
		'enumeration:colour': 'unneeded'
	});
	const fed = looseEnds(graph(THINGS, [...TIES, 'ability:robot.idle acknowledgement variable:robot.pose'].filter((each) => !each.includes('feeds'))));
	expect([...fed.values()]).not.toContain('unfed');
	expect([...looseEnds(graph(THINGS, TIES.filter((each) => !each.includes('feeds')))).values()]).toContain('unfed');
});

test('layers are bands from 3 to 0, with a lane for each resource', () => {
	const bands = bandsOf(WHOLE, { resource: '', kind: '' });
	expect(bands.map(({ layer, count }) => [layer, count])).toEqual([[3, 1], [2, 2], [1, 3], [0, 8]]);
	expect(bands[2]?.lanes.map(({ resource }) => resource)).toEqual([null, 'robot']);
	expect(countsIn(bands[3]?.lanes[1]?.pieces ?? [])).toEqual([['output', 2], ['measured', 1], ['topic', 3]]);
	expect(bandsOf(WHOLE, { resource: 'robot', kind: 'measured' }).map(({ count }) => count)).toEqual([0, 0, 0, 1]);
	expect(bandsOf(WHOLE, { resource: '-', kind: '' }).map(({ count }) => count)).toEqual([1, 2, 1, 2]);
	expect(WHOLE.things.map(shortName)).toContain('move');
});

test('a finding is at the thing in whose lines it is', () => {
	const finding = { kind: 'k', severity: 'warning', message: 'm', file: 'a.yaml', line: at('ability:robot.move') + 1, column: 3 };
	expect([...findingsAt(WHOLE, [finding as never]).keys()]).toEqual([at('ability:robot.move')]);
	expect(findingsAt(WHOLE, [{ ...finding, file: 'b.yaml' } as never]).size).toBe(0);
});

test('things are found by the words of their names, the likeliest first', () => {
	expect(foundBy(WHOLE, 'pose').map(({ id }) => id)).toEqual(['enumeration:pose', 'variable:robot.pose']);
	expect(foundBy(WHOLE, 'ROBOT mov').map(({ id }) => id)).toEqual(['ability:robot.move']);
	expect(foundBy(WHOLE, '  ')).toEqual([]);
});

test('what is looked at is in the address', () => {
	const looked = { example: 'single_bolt', thing: 'topic:/a b', steps: Infinity, loose: true, resource: 'r', kind: 'ability' };
	expect(lookedAt(new URL(addressOf(looked), 'http://h').searchParams)).toEqual(looked);
	expect(addressOf(lookedAt(new URLSearchParams('steps=17')))).toBe('/model?view=graph');
});

test('arrow keys go through rows as they are seen', () => {
	const box = (left: number, top: number) => ({ getBoundingClientRect: () => ({ left, right: left + 50, top, bottom: top + 40 }) });
	const all = [box(0, 0), box(60, 0), box(120, 0), box(0, 50), box(60, 50), box(0, 100)];
	expect(next(all, all[1], 'ArrowDown')).toBe(all[4]);
	expect(next(all, all[2], 'ArrowDown')).toBe(all[4]);
	expect(next(all, all[5], 'ArrowUp')).toBe(all[3]);
	expect(next(all, all[4], 'ArrowUp')).toBe(all[1]);
	expect(next(all, all[2], 'ArrowRight')).toBe(all[3]);
	expect(next(all, all[0], 'ArrowLeft')).toBeNull();
	expect(next(all, all[3], 'End')).toBe(all[5]);
	expect(next(all, {}, 'ArrowDown')).toBeNull();
});

test('what is called after a value is called after its parameter, and by its name where that is all', () => {
	const [thing] = WHOLE.things;
	if (thing === undefined) throw new Error('nothing is there');
	const said = (title: string | null): string | null => spokenName({ ...thing, title });
	expect([said('Place {bolt_pair}'), said('{bolt_pair}'), said(null)]).toEqual(['Place bolt pair', null, null]);
});
