/** How the four steps stand: which are done, and a sentence for each. */
import { isNew, type Keyed } from '#lib/alarm/priority.ts';
import type { AdviceAnswer, StationView } from '#lib/contract.ts';
import { runs } from '#lib/resource/running.ts';
import { told, wordsOf } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { listed } from '#lib/wording/listed.ts';
import { modeMeaning } from '#lib/wording/station.ts';
import { clockText } from '#lib/wording/time.ts';
import { sayActs } from './act-words.ts';
import { openQuestions } from './answers.ts';
import { waysOf } from './choice.ts';
import { correctedText } from './happened.ts';
import { actsTo } from './mode-acts.ts';
import { STEPS, type Next, type Step } from './next.ts';
import { goesOn } from './offer.ts';
import { haltedAlarms, isUnsure, lastingAlarms, movedByHand, notLookedAt } from './shown.ts';
import { resourceTitle } from './titles.ts';

/** Those that lie behind, or in which nothing is to be done; what happened is understood as soon as something else comes next. */
export function doneSteps(view: StationView, step: Step | null, advice: AdviceAnswer | null = null): Record<Step, boolean> {
	const at = step === null ? STEPS.length : STEPS.indexOf(step);
	return {
		understand: at > 0,
		state: at > 0 && isTrue(view) && notLookedAt(view).length === 0,
		ways: at > STEPS.indexOf('ways') && !leavesOut(view, advice) && !haltedAlarms(view).some(([, alarm]) => isNew(alarm)),
		on: at > STEPS.indexOf('on')
	};
}

/** Whether the station would go on without an operation that is to be carried out, as no plan leads to it. */
function leavesOut(view: StationView, advice: AdviceAnswer | null): boolean {
	const first = advice?.revision === view.revision ? advice.offers[0] : undefined;
	return first !== undefined && goesOn(first) && first.left_out.length > 0;
}

/** Nothing is asked of a person about what is so, and it is known whether the station is safe. */
function isTrue(view: StationView): boolean {
	if (view.way_back && isUnsure(view.way_back)) return false;
	return openQuestions(view).length === 0 && !view.unconfirmed && Object.keys(view.undecided).length === 0;
}

export interface Known {
	readonly view: StationView;
	readonly next: Next;
	readonly step: Step | null;
	readonly advice: AdviceAnswer | null;
	/** The time of the station. */
	readonly now: number;
}

/** A sentence for each: what was done, or what there is to do. */
export function stepWords({ view, next, step, advice, now }: Known): Record<Step, string> {
	const { next: acts } = say().restart;
	const unheard = say().restart.steps.notLive;
	// What was so when it was last heard is no word on what is.
	if (next === 'live') return { understand: acts.live, state: unheard, ways: unheard, on: unheard };
	const said = { understand: happened(view), state: state(view, now), ways: ways(view, advice, now), on: on(view) };
	// What a person does next is said where it is done, unless the step says more.
	if (step !== null && next !== 'take' && next !== 'looking' && next !== 'enter') said[step] = acts[next];
	return said;
}

function happened(view: StationView): string {
	const texts = say().restart.steps;
	const [first] = lastingAlarms(view);
	const moving = Object.values(view.abilities).filter(runs).map(({ resource }) => resourceTitle(view, resource));
	const said = [first ? ended(firstOf(wordsOf(first[1]).text)) : modeMeaning(view)];
	const moved = movedText(movedByHand(view));
	if (moved !== null) said.push(moved);
	if (moving.length > 0) said.push(texts.moving([...new Set(moving)].join(', ')));
	if (view.silent.length > 0) said.push(texts.unheard(listed(view.silent), view.silent.length));
	return moving.length + view.silent.length > 0 ? said.join(' ') : `${said.join(' ')} ${texts.still}`;
}

/** What was moved by hand, as its alarms say; null where nothing was. */
function movedText(moved: readonly Keyed[]): string | null {
	return moved.length === 0 ? null : moved.map(([, alarm]) => ended(firstOf(wordsOf(alarm).text))).join(' ');
}

/** The first sentence of several. */
const firstOf = (text: string): string => text.split(/(?<=[.!?]) /)[0] ?? text;

/** With the full stop that a sentence has before another. */
const ended = (text: string): string => (/[.!?]$/.test(text) ? text : `${text}.`);

function state(view: StationView, now: number): string {
	const texts = say().restart.steps;
	const [outputs, questions] = [Object.keys(view.undecided).length, openQuestions(view).length];
	if (outputs > 0) return texts.outputs(outputs);
	if (questions > 0) return texts.questions(questions);
	if (view.unconfirmed) return texts.confirm;
	const moved = movedText(notLookedAt(view));
	if (moved !== null) return `${texts.afterHand} ${moved}`;
	const said = view.last_correction;
	return said?.undoable ? texts.said(said.by, clockText(said.at, now), correctedText(view, said)) : agreeText(view);
}

/** What is not heard says nothing against the state. */
export function agreeText(view: Pick<StationView, 'resources'>): string {
	const texts = say().restart.believed;
	return Object.values(view.resources).some(({ online }) => !online) ? texts.agreeHeard : texts.agree;
}

/** Seconds for which what was carried out is what led to here. */
const LATELY = 600;

function ways(view: StationView, advice: AdviceAnswer | null, now: number): string {
	const texts = say().restart.steps;
	const last = view.last_errand;
	if (view.errand) return texts.runs(told(view.errand.title_message, view.errand.title));
	const found = advice !== null && advice.revision === view.revision ? advice.offers : null;
	const first = haltedAlarms(view).find(([, alarm]) => isNew(alarm));
	if (first) return `${texts.beforeGoingOn} ${ended(firstOf(wordsOf(first[1]).action))}`;
	if (found?.[0] && goesOn(found[0]) && found[0].left_out.length > 0) return texts.leftOut(found[0].left_out.length);
	// What was carried out for a stop before this one is not told again.
	const isLast = last?.done === true && now - last.ended < LATELY && !view.plan.steps.some(({ started }) => started !== null && started > last.ended);
	if (found?.[0] && goesOn(found[0])) return last && isLast ? texts.taken(told(last.title_message, last.title), clockText(last.ended, now)) : texts.nothing;
	if (!isTrue(view)) return texts.afterwards;
	if (found === null) return say().restart.ways.looking;
	const { offered, checked } = waysOf(advice, view);
	if (offered.length === 0) return checked.length === 0 ? texts.none : texts.checked(checked.length);
	return offered.length === 1 ? texts.one : texts.ways(offered.length);
}

function on(view: StationView): string {
	const acts = actsTo('production', view, true);
	return acts.length === 0 ? say().restart.steps.works : `${sayActs(acts)}.`;
}
