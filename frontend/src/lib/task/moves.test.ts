import { expect, test } from 'vitest';
import { task } from '#lib/testing/view.ts';
import { mayMove, surelyOf } from './may-move.ts';
import { movesOf } from './moves.ts';

test('what moves next says who moves, and each once', () => {
	const robot = { name: 'robot', title: 'Robot UR10', moves: ['Move to the place of the nutrunner', 'Lock the tool to the robot'] };
	const dock = { name: 'dock', title: 'Dock', moves: ['Open'] };
	expect(movesOf({ ...task(900), movers: [robot, dock] })).toBe(
		'Robot UR10: Move to the place of the nutrunner, Lock the tool to the robot; Dock: Open'
	);
	expect(movesOf(task(900))).toBe('');
});

test('who may move is told apart from what the plan says', () => {
	const of = { ...task(900), movers: [{ name: 'dock', title: 'Dock', moves: ['Open'] }, { name: 'robot', title: 'Robot UR10', moves: [] }] };
	expect([surelyOf(of), mayMove(of), movesOf(of)]).toEqual(['Dock: Open', ['Robot UR10'], 'Dock: Open; Robot UR10']);
});
