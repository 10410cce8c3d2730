/** What a person does next on the way back to production. It is said, never done by itself. */
import type { AdviceAnswer, StationView } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { asksForHands, goesOn, onlySays } from './offer.ts';
import { wantedFor } from './shown.ts';

export type Next = Exclude<keyof Text['restart']['next'], 'title' | 'there'>;

/** Who looks, and what is known beside the station. */
export interface Standing {
	readonly live: boolean;
	/** Whether they may act. */
	readonly acts: boolean;
	/** Whether they are in control. */
	readonly mine: boolean;
	readonly advice: AdviceAnswer | null;
}

export function nextAct(view: StationView, { live, acts, mine, advice }: Standing): Next {
	if (!live) return 'live';
	const reasons = wantedFor(view);
	if (view.production === 'started' && reasons.length === 0) return 'nothing';
	if (!acts) return 'viewer';
	if (view.errand !== null) return 'errand';
	if (view.production === 'preparing') return 'preparing';
	if (!mine) return 'control';
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

/** The part of the page in which that is done; null where it is not on this page. */
export const PLACE: Record<Next, string | null> = {
	live: null,
	viewer: null,
	control: null,
	nothing: null,
	look: null,
	preparing: null,
	errand: 'errand',
	decide: 'outputs',
	answer: 'believed',
	enter: 'enter',
	start: 'production',
	physical: 'ways',
	take: 'ways',
	check: 'ways',
	looking: 'ways',
	stuck: 'ways',
	leave: 'production',
	continue: 'production'
};
