import { describe, expect, test } from 'vitest';
import { editsOf, isEmpty, removedBy } from './edits.ts';

const PRESENT = {
	'station.yaml': { text: 'name: cell\n' },
	'resources/old.yaml': { text: 'title: Old\n' },
	'operations.yaml': { text: 'a: {}\n' },
	'messages/cell_msgs/msg/Old.msg': { text: 'bool on\n' },
	'messages/cell_msgs/srv/Ask.srv': { text: '---\n' },
	'messages/cell_msgs/action/Go.action': { text: '---\n---\n' }
};
const MADE = { 'station.yaml': 'name: cell\ntitle: Cell\n', 'operations.yaml': 'a: {}\n', 'resources/robot.yaml': 'title: Robot\n' };

describe('what is put into the draft', () => {
	test('is what is written otherwise, what is new, and what is no more but definitions of messages', () => {
		expect(editsOf(MADE, PRESENT)).toEqual([
			{ kind: 'text', file: 'station.yaml', was: 'name: cell\n', text: 'name: cell\ntitle: Cell\n' },
			{ kind: 'text', file: 'resources/robot.yaml', was: null, text: 'title: Robot\n' },
			{ kind: 'text', file: 'resources/old.yaml', was: 'title: Old\n', text: null }
		]);
		expect(removedBy(MADE, PRESENT)).toEqual(['resources/old.yaml']);
	});

	test('is nothing where the draft is that already', () => {
		expect(editsOf({ 'station.yaml': 'name: cell\n' }, { 'station.yaml': { text: 'name: cell\n' } })).toEqual([]);
	});
});

test('a draft is empty where it has nothing but the name of the station', () => {
	const files = { 'station.yaml': { text: '' } };
	expect(isEmpty(files, { 'station.yaml': { name: 'cell' } })).toBe(true);
	expect(isEmpty({}, {})).toBe(true);
	expect(isEmpty(files, { 'station.yaml': { name: 'cell', title: 'Cell' } })).toBe(false);
	expect(isEmpty({ ...files, 'messages/a/msg/B.msg': { text: '' } }, { 'station.yaml': { name: 'cell' } })).toBe(false);
});
