import { describe, expect, test } from 'vitest';
import { made, placesAt, removed } from './making.ts';
import { keysFor } from './suggesting.ts';
import { idOf, lookupOf, nodesOf, partOf, treeOf } from './tree.ts';
import { filled, inherited, layersOf, namesIn, typeFile, typeOf } from './types.ts';

const CONTENTS = {
	'station.yaml': { name: 'line' },
	'types/machine.yaml': {
		parameters: { topic: 'text' },
		title: 'Machine',
		topics: { '/{topic}/state': { direction: 'in' } },
		abilities: { stop: { enabled: 'runs' } }
	},
	'types/belt.yaml': {
		type: 'machine',
		arguments: { topic: 'namespace' },
		parameters: { namespace: 'text', loads: 'enumeration' },
		abilities: { run: { enabled: 'not at_end', effects: { arrives: { takes: 3 } } }, stop: { title: 'Stop it' } }
	},
	'packages/arms/types/robot.yaml': { type: 'base', measured: { at: { type: 'place' } } },
	'packages/arms/types/base.yaml': { output: { speed: { type: '0..3' } } },
	'resources/infeed.yaml': {
		type: 'belt',
		arguments: { namespace: 'infeed' },
		remove: ['abilities.stop'],
		abilities: { run: { enabled: 'at_end' } }
	},
	'resources/arm.yaml': { type: 'arms.robot' },
	'resources/odd.yaml': { type: 'nothing' }
};
const FILES = Object.fromEntries(Object.keys(CONTENTS).map((file) => [file, { digest: file }]));
const INFEED = 'resources/infeed.yaml';
const tree = treeOf(FILES, CONTENTS);
const lookup = lookupOf(tree);
const node = (file: string, ...path: string[]) => lookup.byId.get(idOf(file, path));

describe('what an instance has of its type', () => {
	const layers = layersOf(INFEED, CONTENTS);

	test('comes of all its types, the nearest first, with what parameters are', () => {
		expect(layers.map(({ type, given }) => [type, given])).toEqual([
			['belt', { namespace: 'infeed' }],
			['machine', { topic: 'infeed' }]
		]);
		expect(inherited(layers, ['abilities', 'run', 'enabled'])).toEqual({ type: 'belt', value: 'not at_end' });
		expect(inherited(layers, ['abilities', 'stop', 'enabled'])).toEqual({ type: 'machine', value: 'runs' });
		expect(inherited(layers, ['topics', '/infeed/state', 'direction'])).toEqual({ type: 'machine', value: 'in' });
		expect(inherited(layers, ['abilities', 'none'])).toBeNull();
		expect(namesIn(layers, ['abilities'], ['abilities.stop'])).toEqual([['run', 'belt']]);
		expect(filled('/{topic}/{other}', { topic: 'a' })).toBe('/a/{other}');
	});

	test('is known for types of packages, and not for what there is none of', () => {
		expect(layersOf('resources/arm.yaml', CONTENTS).map(({ file }) => file)).toEqual([
			'packages/arms/types/robot.yaml',
			'packages/arms/types/base.yaml'
		]);
		expect(layersOf('resources/odd.yaml', CONTENTS)).toEqual([]);
		expect(layersOf('a', { a: { type: 'b' }, 'types/b.yaml': { type: 'b' } })).toHaveLength(1);
		for (const name of ['belt', 'arms.robot']) expect(typeOf(typeFile(name))).toBe(name);
		expect(typeOf('resources/belt.yaml')).toBeNull();
	});

	test('is in the tree, marked with its type, and renamed by the name of the instance', () => {
		expect(node(INFEED, 'abilities', 'run')?.of).toBeUndefined();
		expect(node(INFEED, 'abilities', 'run', 'effects', 'arrives')?.of).toBe('belt');
		expect(node(INFEED, 'abilities', 'stop')).toBeUndefined();
		expect(node(INFEED, 'topics', '/infeed/state')?.of).toBe('machine');
		expect(node(INFEED)?.title).toBe('Machine');
		const names = [...nodesOf(tree)].filter(({ kind }) => kind === 'type').map(partOf);
		expect(names).toEqual(['type:arms.base', 'type:arms.robot', 'type:belt', 'type:machine']);
		const run = node('types/belt.yaml', 'abilities', 'run');
		expect(run && partOf(run)).toBe('ability:infeed.run');
		for (const each of nodesOf(tree)) expect(lookup.byId.get(each.id)).toBe(each);
	});

	test('is taken away by name; and what the instance says itself by taking that out', () => {
		const arrives = node(INFEED, 'topics', '/infeed/state');
		expect(arrives && removed(arrives, CONTENTS[INFEED], '')).toEqual([
			{ kind: 'set', file: INFEED, path: ['remove'], was: ['abilities.stop'], value: ['abilities.stop', 'topics./infeed/state'] }
		]);
		const run = node(INFEED, 'abilities', 'run');
		expect(run && removed(run, CONTENTS[INFEED], '')).toMatchObject([{ kind: 'remove', path: ['abilities'] }]);
	});

	test('is asked for when it is made', () => {
		const place = placesAt(null, []).find(({ kind }) => kind === 'resource');
		expect(place && made(place, 'out', { type: 'belt' })).toEqual([
			{ kind: 'add', file: 'resources/out.yaml', path: ['type'], value: 'belt' },
			{ kind: 'add', file: 'resources/out.yaml', path: ['title'], value: 'Out' }
		]);
		expect(keysFor({ file: INFEED, path: ['arguments'] }, CONTENTS)?.names).toEqual(['namespace', 'loads']);
	});
});
