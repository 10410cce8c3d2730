import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Edit } from '#lib/contract.ts';
import { entriesOf, isMapping, valueAt, type Json, type Path } from './content.ts';
import { dropAt } from './dragging.ts';
import { after, duplicatedAll, fewOf, fitting, hindrance, movedTo, oneOn, removedAll, type Deed } from './together.ts';
import { idOf, lookupOf, rowsOf, treeOf, type Node } from './tree.ts';

const ROBOT = 'resources/robot.yaml';
const GRIPPER = 'resources/gripper.yaml';
const CONTENTS: Readonly<Record<string, Json>> = {
	[ROBOT]: {
		type: 'arm',
		measured: { pose: { type: 'pose' } },
		abilities: {
			move: { enabled: true, effects: { arrives: { when: true }, slips: { fault: true } } },
			stop: { enabled: 'a' },
			park: { enabled: 'b' }
		}
	},
	[GRIPPER]: { abilities: { move: { enabled: true }, close: { enabled: true } } },
	'types/arm.yaml': { abilities: { wave: { enabled: true } } },
	'operations.yaml': { a: { goal: true }, b: { goal: true }, c: { goal: true }, d: { goal: true } },
	'messages/p/msg/M.msg': null
};
const TREE = treeOf(Object.fromEntries(Object.keys(CONTENTS).map((file) => [file, { digest: '1' }])), CONTENTS);
const LOOKUP = lookupOf(TREE);
const node = (file: string, ...path: string[]): Node => {
	const found = LOOKUP.byId.get(idOf(file, path));
	if (!found) throw new Error(`${file} ${path.join()}`);
	return found;
};
const ability = (name: string): Node => node(ROBOT, 'abilities', name);
const inList = (file: string, ...path: string[]): readonly Node[] => LOOKUP.parents.get(node(file, ...path).id)?.children ?? [];
const open = (): boolean => false;

/** The content after edits that move, as the server carries them out. */
function movedIn(content: Json | undefined, edits: readonly Edit[]): Json | undefined {
	return edits.reduce<Json | undefined>((value, edit) => {
		if (edit.kind !== 'move') throw new Error(edit.kind);
		const [path, name]: [Path, string] = [edit.path.slice(0, -1), String(edit.path.at(-1))];
		expect(valueAt(value, edit.path)).toEqual(edit.was);
		const entries = entriesOf(valueAt(value, path));
		const [own] = entries.filter(([each]) => each === name);
		const rest = entries.filter(([each]) => each !== name);
		const beside = rest.findIndex(([each]) => each === (edit.before ?? edit.after));
		if (!own || beside < 0) throw new Error(name);
		const list = rest.toSpliced(edit.before === undefined || edit.before === null ? beside + 1 : beside, 0, own);
		const put = (at: Json | undefined, [step, ...further]: Path): Json =>
			step === undefined ? Object.fromEntries(list) : Object.fromEntries(entriesOf(at).map(([key, each]) => [key, key === step ? put(each, further) : each]));
		return put(value, path);
	}, content);
}

describe('several parts', () => {
	const why = (deed: Deed, ...nodes: Node[]) => {
		const found = hindrance(deed, nodes, LOOKUP, open);
		return found && [found.why, found.node.name, found.other?.name ?? null];
	};

	test('what cannot be done together says why, and with which it could', () => {
		expect(why('copy', ability('move'), ability('stop'), node(ROBOT, 'measured', 'pose'))).toBeNull();
		expect(why('copy', ability('move'), node(ROBOT, 'abilities', 'move', 'effects', 'arrives'))).toEqual(['within', 'arrives', 'move']);
		expect(why('remove', node(ROBOT), ability('stop'))).toEqual(['within', 'stop', 'robot']);
		expect(why('remove', node(ROBOT, 'abilities'))).toEqual(['heading', 'abilities', null]);
		expect(why('cut', node(GRIPPER, 'abilities', 'move'), ability('move'))).toEqual(['twice', 'move', 'move']);
		expect(why('copy', node(GRIPPER), ability('move'))).toEqual(['mixed', 'move', 'gripper']);
		expect(why('duplicate', ability('wave'))).toEqual(['typed', 'wave', null]);
		expect(why('remove', ability('wave'), ability('stop'))).toBeNull();
		expect(why('copy', node('messages/p/msg/M.msg'))).toEqual(['message', 'p/msg/M', null]);
		expect(why('move', node(GRIPPER))).toEqual(['unordered', 'gripper', null]);
		expect(why('move', ability('stop'), node(ROBOT, 'measured', 'pose'))).toEqual(['apart', 'pose', 'stop']);
		expect(hindrance('remove', [ability('stop')], LOOKUP, (file) => file === ROBOT)?.why).toBe('locked');
		const all = [node(ROBOT), ability('move'), node(ROBOT, 'abilities'), node(GRIPPER)];
		const { fit, hindrances } = fitting('remove', all, LOOKUP, open);
		expect(fit).toEqual([node(ROBOT), node(GRIPPER)]);
		expect(hindrances.map((each) => each.why)).toEqual(['within', 'heading']);
	});

	test('are taken out one after the other, with the section that is empty then, and nothing else', () => {
		const whole = [ability('move'), ability('stop'), ability('park'), node(ROBOT, 'measured', 'pose')];
		const edits = removedAll([...whole, ability('wave')], CONTENTS, () => '');
		expect(edits.reduce(after, CONTENTS[ROBOT])).toEqual({ type: 'arm', remove: ['abilities.wave'] });
		fc.assert(
			fc.property(fc.shuffledSubarray(whole), (nodes) => {
				const left = removedAll(nodes, CONTENTS, () => '').reduce((content, edit) => {
					if (edit.kind === 'remove') expect(valueAt(content, edit.path)).toEqual(edit.was);
					return after(content, edit);
				}, CONTENTS[ROBOT]);
				for (const each of whole) expect(valueAt(left, each.path)).toEqual(nodes.includes(each) ? undefined : valueAt(CONTENTS[ROBOT], each.path));
				for (const [, value] of entriesOf(left)) expect(isMapping(value) && Object.keys(value).length === 0).toBe(false);
			})
		);
	});

	test('are duplicated each beside itself, under names that are free', () => {
		const made = duplicatedAll([ability('move'), ability('stop'), node(GRIPPER)], LOOKUP, CONTENTS, (file) => `# ${file}`, null);
		expect(made.names).toEqual(['move_2', 'stop_2', 'gripper_2']);
		expect(made.edits).toMatchObject([{ kind: 'add', after: 'move' }, { kind: 'add', after: 'stop' }, { kind: 'text', file: 'resources/gripper_2.yaml', text: `# ${GRIPPER}` }]);
	});

	test('go one up or down together, and no further than to the end', () => {
		const list = inList('operations.yaml', 'a');
		const [a, b, c, d] = list as [Node, Node, Node, Node];
		expect(oneOn([b], list, -1)).toEqual({ node: a, where: 'before' });
		expect(oneOn([b, c], list, 1)).toEqual({ node: d, where: 'after' });
		expect(oneOn([a, c], list, -1)).toBeNull();
		expect(oneOn([d], list, 1)).toBeNull();
		expect(oneOn([ability('wave')], inList(ROBOT, 'abilities', 'stop'), -1)).toBeNull();
		const park = ability('park');
		expect(oneOn([park], inList(ROBOT, 'abilities', 'stop'), 1)).toBeNull(); // behind it is what its type has
	});

	test('moved beside a sibling they stand together, in their order, and all others as they did', () => {
		const list = inList('operations.yaml', 'a');
		fc.assert(
			fc.property(fc.subarray([...list], { minLength: 1, maxLength: 3 }), fc.constantFrom(...list), fc.constantFrom('before' as const, 'after' as const), (nodes, to, where) => {
				fc.pre(!nodes.includes(to));
				const edits = movedTo(nodes, { node: to, where }, list, CONTENTS['operations.yaml']);
				const order = Object.keys(movedIn(CONTENTS['operations.yaml'], edits) as object);
				const names = nodes.map(({ name }) => name);
				const rest = ['a', 'b', 'c', 'd'].filter((each) => !names.includes(each));
				expect(order.filter((each) => !names.includes(each))).toEqual(rest);
				const at = rest.indexOf(to.name) + (where === 'before' ? 0 : 1);
				expect(order).toEqual(rest.toSpliced(at, 0, ...names));
				if (order.join('') === 'abcd') expect(edits).toEqual([]);
			})
		);
		const [a] = list;
		if (a) expect(movedTo([ability('stop')], { node: a, where: 'after' }, list, CONTENTS['operations.yaml'])).toEqual([]);
	});

	test('are named by the first of them', () => {
		expect(fewOf(['a', 'b'], (n) => `+${n}`)).toBe('a, b');
		expect(fewOf(['a', 'b', 'c'], (n) => `+${n}`, 2)).toBe('a, b +1');
	});
});

describe('what is dragged', () => {
	const OPEN = new Set(['#resources', ROBOT, idOf(ROBOT, ['abilities']), idOf(ROBOT, ['abilities', 'move']), GRIPPER, idOf(GRIPPER, ['abilities']), 'operations.yaml']);
	const rows = rowsOf(TREE, OPEN, '');
	const over = (nodes: readonly Node[], at: Node, isUpper: boolean) => {
		const drop = dropAt(rows, nodes, rows.findIndex((row) => row.node.id === at.id), isUpper);
		return drop && [drop.node.name, drop.where, LOOKUP.byId.get(drop.line)?.name, drop.edge];
	};

	test('is put before or after a sibling; what is shown in one counts as that one', () => {
		expect(over([ability('park')], ability('move'), true)).toEqual(['move', 'before', 'move', 'top']);
		expect(over([ability('park')], ability('move'), false)).toEqual(['move', 'after', 'slips', 'bottom']);
		expect(over([ability('park')], node(ROBOT, 'abilities', 'move', 'effects', 'arrives'), true)).toEqual(['move', 'after', 'slips', 'bottom']);
		expect(over([ability('stop')], ability('park'), false)).toEqual(['park', 'after', 'park', 'bottom']);
		expect(over([ability('stop')], node(ROBOT, 'abilities'), true)).toEqual(['move', 'before', 'move', 'top']);
	});

	test('has no place where it stands already, in another list or file, or among what a type has', () => {
		expect(over([ability('stop')], ability('stop'), true)).toBeNull();
		expect(over([ability('stop')], ability('park'), true)).toBeNull();
		expect(over([ability('stop')], ability('wave'), false)).toBeNull();
		expect(over([ability('stop')], node(GRIPPER, 'abilities', 'close'), true)).toBeNull();
		expect(over([ability('stop')], node('operations.yaml', 'a'), true)).toBeNull();
	});

	test('comes to stand where the line is, wherever it is let go', () => {
		const list = inList('operations.yaml', 'a');
		fc.assert(
			fc.property(fc.subarray([...list], { minLength: 1, maxLength: 3 }), fc.nat(rows.length - 1), fc.boolean(), (nodes, place, isUpper) => {
				const drop = dropAt(rows, nodes, place, isUpper);
				if (drop === null) return;
				expect(list).toContain(drop.node);
				expect(nodes).not.toContain(drop.node);
				expect(movedTo(nodes, drop, list, CONTENTS['operations.yaml'])).not.toEqual([]);
			})
		);
	});
});
