import { describe, expect, test } from 'vitest';
import { PARTS } from './documents.ts';
import { made, placesAt, type Place } from './making.ts';
import { pathAt, placesOf } from './places.ts';
import { groupsFor, keysFor, suggestionsFor } from './suggesting.ts';
import { around, idOf, lookupOf, nodeAt, nodesOf, parameterOf, partOf, rowsOf, shapeOf, treeOf } from './tree.ts';

const FILES = {
	'station.yaml': { digest: '1' },
	'resources/robot.yaml': { digest: '2' },
	'operations.yaml': { digest: '3' },
	'messages/robot_msgs/msg/RobotState.msg': { digest: '4' },
	'specifications.yaml': { digest: null }
};
const CONTENTS = {
	'station.yaml': { name: 'station', title: 'Station', enumerations: { pose: ['home'] }, estimated: { part: {} } },
	'resources/robot.yaml': {
		title: 'Robot',
		measured: { pose: { type: 'pose' } },
		abilities: { move: { title: 'Move', effects: { leaves: { kind: 'starting', for: { what: 'tool' } } } } },
		topics: 'nonsense'
	},
	'operations.yaml': { make: { title: 'Make' }, shift: { for: { to: 'pose' }, sequence: 'make' } }
};
const TREE = treeOf(FILES, CONTENTS);
const LOOKUP = lookupOf(TREE);
const MOVE = idOf('resources/robot.yaml', ['abilities', 'move']);

describe('the tree', () => {
	test('has what the files hold, and nothing of what cannot be read', () => {
		const names = [...nodesOf(TREE)].filter(({ kind }) => kind !== 'section').map(({ kind, name }) => `${kind} ${name}`);
		expect(names).toEqual([
			'station station',
			'enumeration pose',
			'variable part',
			'resource robot',
			'variable pose',
			'ability move',
			'effect leaves',
			'operation make',
			'sequence shift',
			'message robot_msgs/msg/RobotState'
		]);
	});

	test('parts have the names by which they are told', () => {
		const parts = [...nodesOf(TREE)].map(partOf).filter((part) => part !== null);
		expect(parts).toEqual([
			'enumeration:pose',
			'variable:part',
			'resource:robot',
			'variable:robot.pose',
			'ability:robot.move',
			'effect:robot.move.leaves',
			'operation:make',
			'sequence:shift',
			'message:robot_msgs/msg/RobotState'
		]);
	});

	test('a parameter is told with what it belongs to', () => {
		const at = (file: string, ...path: string[]): string | null => {
			const node = nodeAt(LOOKUP, file, path);
			return node && parameterOf(node, 'to');
		};
		expect(at('resources/robot.yaml', 'abilities', 'move', 'start', 'when')).toBe('parameter:robot.move.to');
		expect(at('resources/robot.yaml', 'abilities', 'move', 'effects', 'leaves', 'when')).toBe('parameter:robot.move.to');
		const leaves = nodeAt(LOOKUP, 'resources/robot.yaml', ['abilities', 'move', 'effects', 'leaves', 'do', 0]);
		expect(leaves && parameterOf(leaves, 'what')).toBe('parameter:robot.move.leaves.what');
		expect(at('operations.yaml', 'make', 'goal')).toBe('parameter:operation:make.to');
		expect(at('operations.yaml', 'shift', 'sequence')).toBe('parameter:sequence:shift.to');
		expect(at('station.yaml', 'rest')).toBeNull();
	});

	test('what is around a node, and the node that a path belongs to', () => {
		expect(around(LOOKUP, MOVE).map(({ name }) => name)).toEqual(['resources', 'robot', 'abilities']);
		expect(nodeAt(LOOKUP, 'resources/robot.yaml', ['abilities', 'move', 'start', 'do', 0])?.id).toBe(MOVE);
		expect(nodeAt(LOOKUP, 'resources/robot.yaml', ['title'])?.kind).toBe('resource');
		expect(nodeAt(LOOKUP, 'elsewhere.yaml', [])).toBeNull();
	});

	test('rows are those of what is open; a search finds names and titles, with what is around them', () => {
		const robot = idOf('resources/robot.yaml', []);
		const shown = (open: string[], sought: string): string[] =>
			rowsOf(TREE, new Set(open), sought).map(({ node, level }) => `${level} ${node.name}`);
		expect(shown([], '')).toEqual(['1 station', '1 resources', '1 operations', '1 specifications', '1 work_masters', '1 picture', '1 shifts', '1 tests', '1 messages']);
		expect(shown(['#resources', robot], '')).toContain('3 abilities');
		expect(shown([], 'mov')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move']);
		expect(shown([], 'robot.move')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move']);
		expect(shown([], ' Robot.Move.leaves')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move', '5 leaves']);
		// As a name is written in conditions, findings and plans.
		expect(shown([], 'robot.move(home)')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move']);
		expect(shown([], 'robot.move(ho')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move']);
		expect(shown([], 'robot.move.executing')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move']);
		expect(shown([], 'robot.move(home).leaves')).toEqual(['1 resources', '2 robot', '3 abilities', '4 move', '5 leaves']);
		expect(shown([], 'operation.make(home).active')).toEqual(['1 operations', '2 make']);
		expect(shown([], 'nothing like it')).toEqual([]);
	});

	test('is made of 200 resources with 1000 abilities, and a line found in them, in no time', () => {
		const names = Array.from({ length: 200 }, (_, index) => `r${index}`);
		const ability = { title: 'Move', enabled: 'a == b', effects: { e: { kind: 'starting' } } };
		const content = { abilities: Object.fromEntries(['a', 'b', 'c', 'd', 'e'].map((name) => [name, ability])) };
		const files = Object.fromEntries(names.map((name) => [`resources/${name}.yaml`, { digest: name }]));
		const contents = Object.fromEntries(names.map((name) => [`resources/${name}.yaml`, content]));
		const began = performance.now();
		const tree = treeOf(files, contents);
		lookupOf(tree);
		expect(rowsOf(tree, new Set([...nodesOf(tree)].map(({ id }) => id)), '').length).toBeGreaterThan(2400);
		expect(pathAt(placesOf('a:\n  b: c\n'.repeat(1000)), 2000)).toEqual(['a', 'b']);
		expect(performance.now() - began).toBeLessThan(1000);
	});
});

test('after an edit of one file all others are what they were', () => {
	const [, resources] = treeOf(FILES, CONTENTS);
	const edited = { ...CONTENTS, 'resources/arm.yaml': { measured: { pose: {} } } };
	const files = { ...FILES, 'resources/arm.yaml': { digest: '5' } };
	const tree = treeOf(files, edited);
	expect(tree[1]?.children.find(({ name }) => name === 'robot')).toBe(resources?.children[0]);
	// What is looked up is what a look through the whole tree finds.
	const lookup = lookupOf(tree);
	expect(new Set(lookup.byId.values())).toEqual(new Set(nodesOf(tree)));
	for (const node of nodesOf(tree)) {
		expect(lookup.byId.get(node.id)).toBe(node);
		for (const child of node.children) expect(lookup.parents.get(child.id)).toBe(node);
	}
	expect(tree.map(({ id }) => lookup.parents.get(id))).toEqual(tree.map(() => undefined));
	expect(lookup.byId.has('resources/arm.yaml#measured#speed')).toBe(false);
});

describe('what a station says for short', () => {
	const station = {
		enumerations: { spot: ['home', 'out'], pose: { values: ['nowhere'], includes: ['spot'] } },
		sets: { free: { of: 'spot', values: ['home'] } },
		relations: { near: { between: ['spot', 'spot'], pairs: [['home', 'out']] } },
		maps: { place_of: { from: 'spot', to: '0..1', values: { home: 1 }, otherwise: 0 } },
		predicates: { ready: 'goal == home' }
	};
	const robot = { predicates: { is_at: { parameters: { p: 'spot' }, when: 'at == p' } } };
	const files = { 'station.yaml': { digest: '1' }, 'resources/robot.yaml': { digest: '2' } };
	const contents = { 'station.yaml': station, 'resources/robot.yaml': robot };
	const tree = treeOf(files, contents);

	test('is in the tree with the names by which it is told', () => {
		expect([...nodesOf(tree)].map(partOf).filter((part) => part !== null)).toEqual([
			'enumeration:spot',
			'enumeration:pose',
			'set:free',
			'relation:near',
			'map:place_of',
			'predicate:ready',
			'resource:robot',
			'predicate:robot.is_at'
		]);
		const node = nodeAt(lookupOf(tree), 'resources/robot.yaml', ['predicates', 'is_at', 'when']);
		expect(node && parameterOf(node, 'p')).toBe('parameter:robot.is_at.p');
	});

	test('can be made where it belongs', () => {
		const [resource] = [...nodesOf(tree)].filter(({ kind }) => kind === 'resource');
		const places = placesAt(resource ?? null, []).filter(({ kind }) => kind === 'predicate');
		expect(places.map(({ file, path }) => [file, path])).toEqual([
			['resources/robot.yaml', ['predicates']],
			['station.yaml', ['predicates']]
		]);
		expect(made(places[1] as Place, 'all_done', {})).toEqual([
			{ kind: 'add', file: 'station.yaml', path: ['predicates', 'all_done'], value: { title: 'All done', when: false } }
		]);
	});

	test('is made as it is asked for, and has a form', () => {
		const at = (kind: string): Place => placesAt(null, []).find((place) => place.kind === kind) as Place;
		const relation = { between: ['spot', 'spot'], pairs: [['home', 'out']] };
		expect(made(at('set'), 'far', { of: 'spot', values: ['out'] })).toEqual([
			{ kind: 'add', file: 'station.yaml', path: ['sets', 'far'], value: { of: 'spot', values: ['out'] } }
		]);
		expect(made(at('relation'), 'beside', relation)).toEqual([
			{ kind: 'add', file: 'station.yaml', path: ['relations', 'beside'], value: relation }
		]);
		expect(made(at('map'), 'tool', { from: 'spot', to: 'bool', values: {} })).toMatchObject([{ path: ['maps', 'tool'] }]);
		for (const node of nodesOf(tree)) {
			const shape = shapeOf(node);
			expect([node.kind, shape !== null && Object.hasOwn(PARTS, shape)]).toEqual([node.kind, node.kind !== 'section']);
		}
	});

	test('what is written in it is suggested: values, sets of them, and other names', () => {
		const suggested = (...path: string[]): string[] =>
			suggestionsFor(path.at(-1) ?? '', { file: 'station.yaml', path }, contents, Object.keys(files));
		expect(suggested('sets', 'free', 'of')).toEqual(['pose', 'spot']);
		expect(suggested('sets', 'free', 'values')).toEqual(['home', 'out']);
		expect(suggested('relations', 'near', 'between')).toEqual(['free', 'pose', 'spot']);
		expect(suggested('relations', 'near', 'pairs')).toEqual(['home', 'out', 'free']);
		expect(suggested('maps', 'place_of', 'to')).toEqual(['bool', 'free', 'pose', 'spot']);
		expect(suggested('enumerations', 'spot', 'includes')).toEqual(['pose']);
		const rest = { ...station, sets: { free: { of: 'pose', except: ['out'] }, all: { of: 'pose', values: ['free', 'out'] } } };
		const others = { ...contents, 'station.yaml': rest };
		const spot = { file: 'station.yaml', path: ['maps', 'm', 'values'] };
		expect(suggestionsFor('initial', { file: 'x', path: ['initial'] }, { ...others, x: { type: 'all' } }, [])).toEqual(
			['nowhere', 'home', 'out']
		);
		const mapped = { ...others, 'station.yaml': { ...rest, maps: { m: { from: 'free', to: 'bool', otherwise: false } } } };
		expect(keysFor(spot, mapped)).toEqual({ names: ['nowhere', 'home'], otherwise: 'false' });
		expect(groupsFor(spot, mapped)).toEqual(['free']);
		expect(keysFor({ file: 'resources/robot.yaml', path: spot.path }, mapped)).toBeNull();
	});

	test('its names and the values of enumerations that are included are suggested', () => {
		const spot = { file: 'resources/robot.yaml', path: ['measured', 'at', 'initial'] };
		const measured = { ...contents, 'resources/robot.yaml': { measured: { at: { type: 'pose' } } } };
		expect(suggestionsFor('initial', spot, measured, [])).toEqual(['nowhere', 'home', 'out']);
		expect(suggestionsFor('for', spot, measured, [])).toEqual(['free', 'pose', 'spot']);
		const own = { ...measured, 'resources/robot.yaml': { sets: { near: { of: 'pose', values: ['home'] } } } };
		expect(suggestionsFor('parameters', spot, own, [])).toEqual(['free', 'near', 'pose', 'spot']);
	});
});
