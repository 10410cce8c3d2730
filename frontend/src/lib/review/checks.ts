/** What the check of a draft has looked for, one after the other: how it came out, and how long it took. */
import type { ModelCheck } from '#lib/contract.ts';
import { STAGES, stageOf, verdictOf } from '#lib/workshop/verdict.ts';

export type Came = 'done' | 'now' | 'later' | 'bad';

export interface Looked {
	readonly stage: (typeof STAGES)[number];
	readonly came: Came;
	/** Null where it was known before, or is not known yet. */
	readonly seconds: number | null;
}

/** Each stage; what was known of this very model before took no time. */
export function lookedFor(check: ModelCheck): Looked[] {
	const verdict = verdictOf(check);
	const at = stageOf(check);
	const took = new Map(check.looked.map(({ what, seconds }) => [what, seconds]));
	const broken = verdict === 'unusable' ? failedAt(check) : verdict === 'unmeetable' ? 'the safe states' : null;
	let ended = false;
	return STAGES.map((stage, place) => {
		const seconds = took.get(stage) ?? null;
		const came: Came = stage === broken ? 'bad' : ended ? 'later' : at === null ? (seconds === null ? 'later' : 'done') : place < at ? 'done' : place === at && verdict !== 'failed' ? 'now' : 'later';
		ended ||= came === 'bad';
		return { stage, came, seconds };
	});
}

/** At which stage a draft that cannot be used was given up. */
function failedAt(check: ModelCheck): Looked['stage'] {
	const last = check.looked.at(-1)?.what;
	return STAGES.find((stage) => stage === last) ?? STAGES[0];
}
