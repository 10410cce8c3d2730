import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Variable } from '#lib/contract.ts';
import { inRows, type Named } from './pairs.ts';

const POSES = ['home', 'above_engine'];

function variable(kind: Variable['kind'], domain: Variable['domain'], resource = 'robot'): Variable {
	return { resource, kind, domain, dual_approval: false, value: null, since: null, awaits: null, belief: null, commanded_by: null };
}

function told(variables: readonly Named[]): [string, string | null][] {
	return inRows(variables).map((row) => [row.name, row.command?.[0] ?? null]);
}

test('the commands of the truck engine station stand beside what answers them', () => {
	expect(
		told([
			['robot.pose', variable('measured', ['unknown', ...POSES])],
			['robot.previous_pose', variable('measured', POSES)],
			['robot.moving', variable('measured', [false, true])],
			['robot.tool_is_attached', variable('measured', [false, true])],
			['robot.target_pose', variable('output', POSES)],
			['robot.attach_tool', variable('output', [false, true])]
		])
	).toEqual([
		['robot.pose', 'robot.target_pose'],
		['robot.previous_pose', null],
		['robot.moving', null],
		['robot.tool_is_attached', 'robot.attach_tool']
	]);
	expect(
		told([
			['nutrunner.tool_is_idle', variable('measured', [false, true])],
			['nutrunner.tool_is_running_forward', variable('measured', [false, true])],
			['nutrunner.programmed_torque_reached', variable('measured', [false, true])],
			['nutrunner.set_tool_idle', variable('output', [false, true])],
			['nutrunner.run_tool_forward', variable('output', [false, true])]
		].map(([name, v]) => [name, { ...(v as Variable), resource: 'nutrunner' }] as Named))
	).toEqual([
		['nutrunner.tool_is_idle', 'nutrunner.set_tool_idle'],
		['nutrunner.tool_is_running_forward', 'nutrunner.run_tool_forward'],
		['nutrunner.programmed_torque_reached', null]
	]);
});

test('a command that nothing answers, or that shares its answer with another, keeps a row of its own', () => {
	expect(
		told([
			['operator.acknowledged', variable('measured', [false, true])],
			['operator.requested_pair', variable('output', ['none', 'bolt_pair_1'])]
		])
	).toEqual([
		['operator.acknowledged', null],
		['operator.requested_pair', null]
	]);
	expect(
		told([
			['robot.pose', variable('measured', POSES)],
			['robot.target_pose', variable('output', POSES)],
			['robot.set_pose', variable('output', POSES)]
		])
	).toEqual([
		['robot.pose', null],
		['robot.target_pose', null],
		['robot.set_pose', null]
	]);
});

test('whatever the names, every variable is shown once, and only commands are folded', () => {
	const word = fc.constantFrom('pose', 'target', 'tool', 'is', 'run', 'running', 'set', 'idle');
	const name = fc.array(word, { minLength: 1, maxLength: 3 }).map((words) => `robot.${words.join('_')}`);
	const kind = fc.constantFrom<Variable['kind']>('measured', 'output', 'estimated');
	fc.assert(
		fc.property(fc.uniqueArray(fc.tuple(name, kind), { selector: ([n]) => n }), (list) => {
			const variables = list.map(([n, k]): Named => [n, variable(k, [false, true])]);
			const rows = inRows(variables);
			const shown = rows.flatMap((row) => [row.name, ...(row.command ? [row.command[0]] : [])]);
			expect([...shown].sort()).toEqual(variables.map(([n]) => n).sort());
			for (const { variable, command } of rows)
				if (command) expect([variable.kind, command[1].kind]).toEqual(['measured', 'output']);
		})
	);
});
