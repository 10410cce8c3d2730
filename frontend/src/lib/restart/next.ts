/** What a person does next on the way back to production. It is said, never done by itself. */
import type { AdviceAnswer, StationView } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { openQuestions } from './answers.ts';
import { asksForHands, goesOn, onlySays } from './offer.ts';
import { wantedFor } from './shown.ts';

export type Next = Exclude<keyof Text['restart']['next'], 'title'>;

/** Who looks, and what is known beside the station. */
export interface Standing {
	readonly live: boolean;
	/** Whether they may act. */
	readonly acts: boolean;
	readonly advice: AdviceAnswer | null;
}

export function nextAct(view: StationView, { live, acts, advice }: Standing): Next {
	if (!live) return 'live';
	const reasons = wantedFor(view);
	if (view.production === 'started' && reasons.length === 0) return 'nothing';
	if (!acts) return 'viewer';
	if (view.errand !== null) return 'errand';
	if (view.production === 'preparing') return 'preparing';
	if (Object.keys(view.undecided).length > 0) return 'decide';
	if (reasons.includes('questions')) return view.production === 'waiting' || view.mode === 'restart' ? 'answer' : 'enter';
	if (view.unconfirmed && view.production === 'waiting') return 'answer';
	if (view.production === 'waiting') return 'start';
	if (reasons.every((reason) => reason === 'unconfirmed')) return 'answer';
	if (reasons.includes('outside') && view.mode !== 'restart') return 'enter';
	return offered(view, advice);
}

/** By what is offered from the present state. */
function offered(view: StationView, advice: AdviceAnswer | null): Next {
	const inside = view.mode === 'restart';
	if (advice === null || advice.revision !== view.revision) return 'looking';
	const [first] = advice.offers;
	if (first === undefined && advice.if_checked.length === 0) return 'stuck';
	// What is only said is said in restart mode.
	if (first === undefined || onlySays(first)) return inside ? 'check' : 'enter';
	if (asksForHands(first)) return 'physical';
	if (!goesOn(first)) return inside ? 'take' : 'enter';
	if (inside) return 'leave';
	if (view.mode !== 'automatic') return 'continue';
	return wantedFor(view).every((reason) => reason === 'alarm') ? 'look' : 'enter';
}

/** The four steps from what happened to production, in their order. */
export const STEPS = ['understand', 'state', 'ways', 'on'] as const;
export type Step = (typeof STEPS)[number];

const STEP: Record<Exclude<Next, 'enter' | 'nothing'>, Step> = {
	live: 'understand',
	viewer: 'understand',
	preparing: 'understand',
	look: 'understand',
	decide: 'state',
	answer: 'state',
	errand: 'ways',
	physical: 'ways',
	take: 'ways',
	check: 'ways',
	looking: 'ways',
	stuck: 'ways',
	start: 'on',
	leave: 'on',
	continue: 'on'
};

/** The step in which that is done; null where there is nothing to do. Restart mode is entered within the step that needs it. */
export function stepOf(next: Next, view: Pick<StationView, 'questions' | 'alarms' | 'variables'>): Step | null {
	if (next === 'nothing') return null;
	if (next === 'enter') return openQuestions(view).length > 0 ? 'state' : 'ways';
	return STEP[next];
}
