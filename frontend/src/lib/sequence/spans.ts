/**
 * When operations were under way, are, and are expected to be, as far as it is known of this round and planned; and when in that
 * time somebody works for them, and when they wait.
 */
import type { Operation, PlanStep, StationView } from '#lib/contract.ts';
import { standingsOf, stepsOf, type OperationStanding } from '#lib/operation/standing.ts';
import { hasBegun, lateness, timesOf } from '#lib/plan/lanes.ts';

/** How a part of it is drawn: somebody worked, works, will work, or came to no end; or it waits. */
export type Tone = 'past' | 'run' | 'plan' | 'fail' | 'wait';

export interface Piece {
	readonly from: number;
	readonly to: number;
	readonly tone: Tone;
}

export interface Span {
	readonly from: number;
	readonly to: number;
	/** One after another, without gaps. */
	readonly pieces: readonly Piece[];
	/** Seconds up to now in which somebody worked for it, and in which it waited. */
	readonly worked: number;
	readonly waited: number;
}

/** Seconds below which nobody sees it wait. */
const SHORT = 0.3;

/** The span of each operation, by name; none where nothing is known. Times are seconds since the epoch. */
export function spansOf(view: StationView, now: number): Map<string, Span> {
	const found = new Map<string, Span>();
	const standings = standingsOf(view);
	const late = lateness(view.plan.steps, now);
	for (const [name, operation] of Object.entries(view.operations)) {
		const standing = standings.get(name) ?? 'waits';
		const { began, ended, active, active_since } = operation;
		if (active && active_since !== null) {
			const work = [...workOf(operation, standing, view, now), ...aheadOf(stepsOf(view.plan, operation), now, late)];
			found.set(name, spanOf(active_since, Math.max(now, active_since, ...work.map(({ to }) => to)), work, now));
		} else if (standing === 'done' && began !== null && ended !== null) found.set(name, spanOf(began, ended, workOf(operation, standing, view, now), now));
	}
	return found;
}

/** When somebody worked for it; what goes on lasts to the end that is expected, or to the present where that is over. */
function workOf(operation: Operation, standing: OperationStanding, { plan }: StationView, now: number): Piece[] {
	const running = stepsOf(plan, operation).filter(({ status }) => status === 'running');
	const end = Math.max(now, ...running.map((step) => step.expected_end ?? now));
	return operation.work.map(({ began, ended }) => {
		if (ended !== null) return { from: began, to: ended, tone: 'past' };
		return { from: began, to: end, tone: standing === 'stopped' ? 'fail' : 'run' };
	});
}

/** When somebody is going to work for it. */
function aheadOf(steps: readonly PlanStep[], now: number, late: number): Piece[] {
	return steps
		.filter((step) => !hasBegun(step))
		.map((step) => {
			const { start, end } = timesOf(step, now, late);
			return { from: now + start, to: now + end, tone: 'plan' };
		});
}

/** Between the pieces of `work` it waits. */
function spanOf(from: number, to: number, work: readonly Piece[], now: number): Span {
	const pieces: Piece[] = [];
	let at = from;
	for (const piece of [...work].sort((a, b) => a.from - b.from)) {
		const [begin, end] = [Math.max(piece.from, at), Math.min(piece.to, to)];
		if (end <= begin) continue;
		const waits = begin - at > SHORT;
		const last = pieces.at(-1);
		if (waits) pieces.push({ from: at, to: begin, tone: 'wait' });
		if (!waits && last?.tone === piece.tone) pieces[pieces.length - 1] = { ...last, to: end };
		else pieces.push({ from: waits ? begin : at, to: end, tone: piece.tone });
		at = end;
	}
	if (to - at > SHORT || pieces.length === 0) pieces.push({ from: at, to, tone: 'wait' });
	const passed = (waits: boolean): number =>
		pieces.reduce((sum, piece) => sum + ((piece.tone === 'wait') === waits ? Math.max(0, Math.min(piece.to, now) - piece.from) : 0), 0);
	return { from, to: Math.max(at, to), pieces, worked: passed(false), waited: passed(true) };
}
