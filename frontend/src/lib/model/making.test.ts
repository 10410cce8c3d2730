import { describe, expect, test } from 'vitest';
import { copied, made, placesAt, removed, taken, written } from './making.ts';
import { keysOfOthers, SPECIFICATIONS } from './specification.ts';
import { lookupOf, treeOf, around, idOf } from './tree.ts';

const FILE = 'resources/robot.yaml';
const CONTENT = {
	measured: { pose: { type: 'pose' } },
	abilities: { move: { enabled: true, start: { do: ['a := b'] } }, stop: { enabled: 'a' } }
};
const LOOKUP = lookupOf(treeOf({ [FILE]: { digest: '1' } }, { [FILE]: CONTENT }));
const node = (...path: string[]) => {
	const found = LOOKUP.byId.get(idOf(FILE, path));
	if (!found) throw new Error(path.join());
	return found;
};

describe('edits', () => {
	test('a value is set, added or taken out with what was seen', () => {
		const path = ['abilities', 'stop', 'enabled'];
		expect(written(FILE, CONTENT, path, 'a', 'b', 2)).toEqual([{ kind: 'set', file: FILE, path, was: 'a', value: 'b' }]);
		expect(written(FILE, CONTENT, path, 'a', 'a', 2)).toEqual([]);
		expect(written(FILE, CONTENT, path, 'other', undefined, 2)).toEqual([{ kind: 'remove', file: FILE, path, was: 'other' }]);
		const title = ['abilities', 'stop', 'title'];
		expect(written(FILE, CONTENT, title, undefined, 'Stop', 2)).toEqual([{ kind: 'add', file: FILE, path: title, value: 'Stop' }]);
		expect(written(FILE, CONTENT, title, undefined, undefined, 2)).toEqual([]);
	});

	test('with the last entry of a part the part goes too, but not what it belongs to', () => {
		const start = ['abilities', 'move', 'start'];
		expect(taken(FILE, CONTENT, [...start, 'do'], 2)).toEqual([
			{ kind: 'remove', file: FILE, path: start, was: { do: ['a := b'] } }
		]);
		expect(taken(FILE, CONTENT, ['abilities', 'stop', 'enabled'], 2)).toEqual([
			{ kind: 'remove', file: FILE, path: ['abilities', 'stop', 'enabled'], was: 'a' }
		]);
		expect(removed(node('measured', 'pose'), CONTENT, '')).toEqual([
			{ kind: 'remove', file: FILE, path: ['measured'], was: { pose: { type: 'pose' } } }
		]);
		expect(removed(node(), CONTENT, 'text')).toEqual([{ kind: 'text', file: FILE, was: 'text', text: null }]);
	});

	test('a copy stands behind what it is a copy of; a resource is copied as it is written', () => {
		expect(copied(node('abilities', 'move'), 'go', CONTENT, '', null)).toEqual([
			{ kind: 'add', file: FILE, path: ['abilities', 'go'], value: CONTENT.abilities.move, after: 'move' }
		]);
		expect(copied(node(), 'arm', CONTENT, '# text', null)).toEqual([{ kind: 'text', file: 'resources/arm.yaml', was: null, text: '# text' }]);
	});

	test('what is chosen says where something new belongs first', () => {
		const first = (...path: string[]) => {
			const at = node(...path);
			const [place] = placesAt(at, around(LOOKUP, at.id));
			return place && `${place.section} ${place.file}`;
		};
		expect(first('abilities', 'move')).toBe(`abilities ${FILE}`);
		expect(first('measured')).toBe(`measured ${FILE}`);
		expect(first()).toBe('resources ');
		expect(placesAt(null, []).some(({ kind }) => kind === 'ability')).toBe(false);
	});

	test('new things are in their place', () => {
		const [ability] = made({ kind: 'ability', file: FILE, path: ['abilities'], section: 'abilities' }, 'go_home', {});
		expect(ability).toEqual({ kind: 'add', file: FILE, path: ['abilities', 'go_home'], value: { title: 'Go home', enabled: false } });
		const place = { kind: 'specification', file: 'specifications.yaml', path: [], section: 'specifications' } as const;
		expect(made(place, 'apart', SPECIFICATIONS.never)).toMatchObject([
			{ path: ['apart'], value: { title: 'Apart', never: false, while: false } }
		]);
		expect(made(place, 'bad', {})).toMatchObject([{ value: { title: 'Bad', forbidden: false } }]);
		expect(made({ kind: 'resource', file: '', path: null, section: 'resources' }, 'arm', {})).toEqual([
			{ kind: 'add', file: 'resources/arm.yaml', path: ['title'], value: 'Arm' }
		]);
		expect(made({ kind: 'message', file: '', path: null, section: 'messages' }, 'a/srv/B', {})).toEqual([
			{ kind: 'text', file: 'messages/a/srv/B.srv', was: null, text: '' }
		]);
	});
});

test('a specification has the fields of its kind, and all of them while that is open', () => {
	const hidden = (...there: string[]): string[] => keysOfOthers((key) => there.includes(key));
	expect(hidden('title', 'never')).toEqual(['forbidden', 'exclusive', 'zone', 'order']);
	expect(hidden('forbidden', 'order')).toEqual(['never', 'while', 'exclusive', 'zone']);
	expect(hidden('title')).toEqual([]);
});
