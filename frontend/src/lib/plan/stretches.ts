/** What the plan is for: the stretch of time in which it serves each operation. */
import type { Operation, PlanStep, StationView } from '#lib/contract.ts';
import { isAtWork, tookOf } from '#lib/operation/standing.ts';
import { hasBegun, lateness, timesOf } from './lanes.ts';

export interface Stretch {
	readonly operation: string;
	readonly title: string;
	/** In seconds after the present. */
	readonly from: number;
	readonly to: number;
	readonly standing: 'past' | 'now' | 'ahead' | 'expected';
	/** One below the other where several begin at nearly the same time. */
	readonly row: number;
}

/** As many rows as there are at most: the list of operations has them all. */
export const ROWS = 2;

/** What begins once a task is done, at the time at which that is expected, and for as long as such a one took last. */
export function expectedOf({ operations, tasks, plan }: Pick<StationView, 'operations' | 'tasks' | 'plan'>, now: number): Omit<Stretch, 'row'>[] {
	const all = Object.entries(operations);
	return Object.values(tasks).flatMap(({ ability, begins }) => {
		const step = plan.steps.find((each) => each.ability === ability && each.status === 'running');
		if (step?.expected_end == null) return [];
		const from = Math.max(0, step.expected_end - now);
		return begins.flatMap((title) => {
			const [name, operation] = all.find(([, each]) => each.title === title && !each.active) ?? [];
			if (name === undefined || operation === undefined) return [];
			const alike = all.filter(([other]) => other.split('(')[0] === name.split('(')[0]).map(([, each]) => tookOf(each));
			const took = tookOf(operation) ?? alike.find((seconds) => seconds !== null) ?? 0;
			return [{ operation: name, title, from, to: from + took, standing: 'expected' as const }];
		});
	});
}

/**
 * Those from `since` seconds ago on, in the order in which they begin; `words` is the time that a name needs, `under` are those that the
 * list of operations shows as under way, and `expected` what is expected beyond the plan.
 */
export function stretchesOf(
	operations: Readonly<Record<string, Operation>>,
	steps: readonly PlanStep[],
	now: number,
	since: number,
	words: number,
	under: ReadonlySet<string> = new Set(),
	expected: readonly Omit<Stretch, 'row'>[] = []
): Stretch[] {
	const late = lateness(steps, now);
	const byId = new Map(steps.map((step) => [step.id, step]));
	const found: Omit<Stretch, 'row'>[] = [...expected];
	for (const [operation, each] of Object.entries(operations)) {
		const { title, active, active_since, began, ended, first_step, last_step } = each;
		if (began !== null && ended !== null && ended - now > -since && !active)
			found.push({ operation, title, from: began - now, to: ended - now, standing: 'past' });
		const first = byId.get(first_step ?? '');
		const last = byId.get(last_step ?? '');
		if (!active || active_since === null) continue;
		const running = isAtWork(each) ? each.work.at(-1) : undefined;
		const to = last ? Math.max(0, timesOf(last, now, late).end) : 0;
		if (first && hasBegun(first)) found.push({ operation, title, from: Math.max(active_since, first.started ?? active_since) - now, to, standing: 'now' });
		// A plan that was made meanwhile has the rest of it alone, and without a plan what runs goes on.
		else if (running) found.push({ operation, title, from: running.began - now, to, standing: 'now' });
		// What the list shows as under way is under way here, too, though its first step comes only after those of others.
		else if (first && under.has(operation)) found.push({ operation, title, from: active_since - now, to, standing: 'now' });
		// What is left out of the plan is served by none of its steps.
		else if (first) found.push({ operation, title, from: timesOf(first, now, late).start, to, standing: 'ahead' });
	}
	found.sort((a, b) => a.from - b.from || a.to - b.to);
	const rows: Stretch[][] = [];
	for (const stretch of found) {
		const from = Math.max(stretch.from, -since);
		const free = rows.findIndex((row) => (row.at(-1)?.from ?? -Infinity) + words <= from);
		// What goes on or comes has its place before what is over.
		const over = stretch.standing === 'past' ? -1 : rows.findIndex((row) => row.at(-1)?.standing === 'past');
		const row = free !== -1 ? free : rows.length < ROWS ? rows.length : over;
		if (row === -1) continue;
		const kept = rows[row] ?? [];
		if (free === -1) kept.pop();
		rows[row] = [...kept, { ...stretch, from, row }];
	}
	return rows.flat().sort((a, b) => a.from - b.from || a.row - b.row);
}

/**
 * Where the name of a stretch must end: where the next of its row begins. That of one that is over, for which `words` are
 * needed, does not reach beyond the present, nor beyond its own end where that lies before what is in sight from `left` on:
 * it would be taken for what goes on.
 */
export function roomOf(stretches: readonly Stretch[], index: number, words: number, left = -Infinity): number {
	const stretch = stretches[index];
	const next = stretches.slice(index + 1).find(({ row }) => row === stretch?.row)?.from ?? Infinity;
	if (stretch?.standing !== 'past') return next;
	return Math.min(next, Math.max(stretch.to < left ? stretch.to : 0, stretch.from + words));
}
