import * as yaml from 'yaml';
import { describe, expect, test } from 'vitest';
import { partsText, pastedAt, type Pasted } from './clipboard.ts';
import { idOf, lookupOf, treeOf } from './tree.ts';

const ROBOT = 'resources/robot.yaml';
const GRIPPER = 'resources/gripper.yaml';
const move = { enabled: 'pose != home', effects: { arrives: { kind: 'executing', when: true, do: ['pose := home'] } } };
const CONTENTS = {
	[ROBOT]: { title: 'Robot', measured: { pose: { type: 'pose' } }, abilities: { move } },
	[GRIPPER]: { abilities: { close: { enabled: true } } },
	'station.yaml': { enumerations: { pose: ['home', 'away'] } },
	'operations.yaml': { assemble: { goal: true, precondition: false } }
};
const LOOKUP = lookupOf(treeOf(Object.fromEntries(Object.keys(CONTENTS).map((file) => [file, { digest: '1' }])), CONTENTS));
const node = (file: string, ...path: string[]) => {
	const found = LOOKUP.byId.get(idOf(file, path));
	if (!found) throw new Error(`${file} ${path.join()}`);
	return found;
};
const fileText = (file: string): string => yaml.stringify(CONTENTS[file as keyof typeof CONTENTS]);
const text = (file: string, ...path: string[]): string => partsText([node(file, ...path)], CONTENTS, fileText, yaml) ?? '';
const paste = (what: string, at: ReturnType<typeof node> | null) => pastedAt(what, at, LOOKUP, CONTENTS, yaml);
const pasted = (what: string, at: ReturnType<typeof node> | null): Pasted => {
	const found = paste(what, at);
	if (!('edits' in found)) throw new Error(`not pasted: ${found.section}`);
	return found;
};

describe('parts in the clipboard', () => {
	test('are written below the section of their file', () => {
		expect(yaml.parse(text(ROBOT, 'abilities', 'move'))).toEqual({ abilities: { move } });
		expect(yaml.parse(text(ROBOT, 'abilities', 'move', 'effects', 'arrives'))).toEqual({ effects: { arrives: move.effects.arrives } });
		expect(yaml.parse(text(ROBOT))).toEqual({ resources: { robot: CONTENTS[ROBOT] } });
		expect(yaml.parse(text('operations.yaml', 'assemble'))).toEqual({ operations: CONTENTS['operations.yaml'] });
		expect(yaml.parse(text('station.yaml', 'enumerations', 'pose'))).toEqual({ enumerations: { pose: ['home', 'away'] } });
	});

	test('keep their comments and their style, and what stands for something else is written out', () => {
		const file = 'title: Robot\nabilities:\n  move:\n    # why\n    enabled: pose != home # not there\n    effects: {arrives: {kind: executing, when: true, do: ["pose := home"]}}\n';
		const copied = partsText([node(ROBOT, 'abilities', 'move')], CONTENTS, () => file, yaml) ?? '';
		expect(copied).toContain('    # why\n    enabled: pose != home # not there\n    effects: {');
		const [edit] = pasted(copied, node(GRIPPER, 'abilities', 'close')).edits;
		expect(edit).toMatchObject({ kind: 'add', value: move });
		expect(edit?.kind === 'add' && edit.text).toContain('# why\nenabled: pose != home # not there\n');
		const anchored = file.replace('enabled: pose != home # not there', 'enabled: &a pose != home');
		expect(partsText([node(ROBOT, 'abilities', 'move')], CONTENTS, () => anchored, yaml)).toBe(yaml.stringify({ abilities: { move } }));
	});

	test('come to the resource that is chosen, and keep their name where it is free', () => {
		const { edits, names, at } = pasted(text(ROBOT, 'abilities', 'move'), node(GRIPPER, 'abilities', 'close'));
		expect(names).toEqual(['move']);
		expect(edits).toEqual([{ kind: 'add', file: GRIPPER, path: ['abilities', 'move'], value: move }]);
		expect(at).toEqual([{ file: GRIPPER, path: ['abilities', 'move'] }]);
		expect(pasted(text(ROBOT, 'abilities', 'move'), node(ROBOT)).names).toEqual(['move_2']);
	});

	test('may be several, of the station or whole resources', () => {
		const several = 'abilities:\n  a: {enabled: true}\n  b: {enabled: false}\nmeasured:\n  seen: {type: bool}\n';
		expect(pasted(several, node(ROBOT)).names).toEqual(['a', 'b', 'seen']);
		expect(pasted(text('operations.yaml', 'assemble'), node(ROBOT)).edits).toMatchObject([{ file: 'operations.yaml', path: ['assemble_2'] }]);
		const whole = pasted(text(ROBOT), null);
		expect(whole.at).toEqual([{ file: 'resources/robot_2.yaml', path: [] }]);
		expect(whole.edits.map((edit) => edit.kind === 'add' && edit.path)).toEqual([['title'], ['measured'], ['abilities']]);
	});

	test('change nothing where they have no place, or are none', () => {
		expect(paste('abilities: {move: {}}', null)).toEqual({ section: 'abilities' });
		expect(paste('nonsense: {move: {}}', node(ROBOT))).toEqual({ section: 'nonsense' });
		for (const none of ['', 'hello', '- 1', 'abilities: [1]', 'abilities: {move: [', '{}']) expect(paste(none, node(ROBOT))).toEqual({ section: null });
	});
});
