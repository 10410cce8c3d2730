/** How an offer is said in short. */
import type { StationView, WayOffer } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { say, type Text } from '#lib/text/text.svelte.ts';
import { inSentence, nameOf, valueOf } from '#lib/wording/names.svelte.ts';
import { asksForHands, canBeTaken, isSoAlready, onlySays } from './offer.ts';
import { lengthOf } from './preview-lanes.ts';
import { returning } from './returning.ts';
import { operationTitles, resourceTitle } from './titles.ts';

type Ways = Text['restart']['ways'];
type Known = Pick<StationView, 'operations' | 'resources'> | null;

/** So many starts, or operations, are told of in a sentence; the rest is counted. */
const TOLD = 3;

/** Seconds by which a sum may be wrong. */
const TRIFLE = 1e-6;

/** What it asks for; a kind that this page does not know keeps its own word. */
export function kindWord({ kinds }: Pick<Ways, 'kinds'>, kind: string): string {
	return Object.entries(kinds).find(([name]) => name === kind)?.[1] ?? kind;
}

/** How long it takes: `≈ 13 s`, `≈ 1 min 20 s`; only minutes where they are many. */
export function timeWords(texts: Pick<Ways, 'seconds' | 'minutes'>, seconds: number): string {
	// A sum of seconds may be a trifle more than they are.
	const whole = Math.ceil(seconds - TRIFLE);
	if (whole < 60) return texts.seconds(whole);
	return whole < 600 ? texts.minutes(Math.floor(whole / 60), whole % 60) : texts.minutes(Math.round(whole / 60), 0);
}

/** Seconds of a way: its own, and those with what the station does afterwards, where that is more. What has nothing of its own is told as a whole. */
export function timesOf({ effort, errand, then }: WayOffer): { readonly own: number; readonly all: number } {
	const all = effort.time;
	const own = errand && then && then.steps.length > 0 ? Math.min(all, lengthOf(errand) + effort.time - effort.seconds) : all;
	return { own, all };
}

/** What it is called; where it only says what is true, with the warning that somebody has to have looked. */
export function titleOf(offer: WayOffer): string {
	return offer.only_if_checked && onlySays(offer) && tasksOf(offer).length === 0 ? say().restart.ways.onlyIf(saidOf(offer)) : told(offer.title_message, offer.title);
}

/** That a variable has the value it would get: `pair 4 is placed`. */
export function soOf({ so, name, then }: WayOffer['corrections'][number]): string {
	return told(so, say().restart.ways.is(inSentence(nameOf(name, null)), valueOf(name, then)));
}

/** What a person does before it is true: a task, with the instruction for it. */
export function tasksOf({ corrections }: Pick<WayOffer, 'corrections'>): string[] {
	return corrections.flatMap(({ by_hand: how }) => (how === null ? [] : [told(how, '')]));
}

/** What it says of the product. */
export function saidOf({ corrections }: Pick<WayOffer, 'corrections'>): string {
	return corrections.map(soOf).join(', ');
}

/** What of that which a person does first is not so yet; null where all of it is. */
export function stillAsked(view: StationView, { online, in_service, physical }: WayOffer): string | null {
	const { still: texts, now } = say().restart.ways;
	const parts = [
		...online.flatMap((name) => {
			const { how } = returning(view, name);
			return how === 'back' ? [] : [texts[how](resourceTitle(view, name))];
		}),
		...in_service.map((name) => texts.out(view.abilities[name]?.title ?? name)),
		...physical.map((change) => texts.other(soOf(change), now(valueOf(change.name, change.now))))
	];
	return parts.length === 0 ? null : texts.checked(parts.join(', '));
}

/** So much a person does by hand, before it or within it. */
export function handsOf({ physical, online, in_service, errand, corrections }: WayOffer): number {
	return tasksOf({ corrections }).length + physical.length + online.length + in_service.length + (errand?.steps.filter((step) => step.human).length ?? 0);
}

/** The resources that move in it, each once. */
export function resourcesOf({ errand }: Pick<WayOffer, 'errand'>): string[] {
	return [...new Set(errand?.steps.filter((step) => !step.human).map((step) => step.resource))];
}

/** What a person makes sure of before it is carried out, with what moves first. */
export function assured(view: Known, { errand }: Pick<WayOffer, 'errand'>, { take: texts }: Pick<Text['restart'], 'take'> = say().restart): string {
	const steps = errand?.steps ?? [];
	if (steps.length === 0) return texts.mayWait;
	const first = steps.find((step) => step.moves && !step.human);
	return first ? texts.nobodyIn(resourceTitle(view, first.resource), first.title, steps.length) : texts.haveRead(steps.length);
}

/** What happens, in a sentence or two. */
export function storyOf(view: Known, offer: WayOffer): string {
	const texts = say().restart.ways;
	// What somebody says to be done already does not come then.
	const goals = operationTitles(view, offer.goals.filter((name) => !offer.claims.includes(name)));
	const then = goals.length === 0 ? texts.goalsPlain : texts.goals(few(texts, goals));
	// Its title says what is done by hand, and what is started.
	if (asksForHands(offer)) return then;
	if (offer.errand !== null) return isTitledByStarts(offer) ? `${offer.into_safe ? `${texts.intoSafe} ` : ''}${then}` : startsOf(view, offer);
	// What it corrects is among its facts, and in its title.
	return canBeTaken(offer) ? then : `${texts.goOn} ${then}`;
}

/** Whether its title is what is started, and not what that is for. */
function isTitledByStarts({ kind, operation, errand }: WayOffer): boolean {
	return operation === null && kind !== 'goal' && (errand?.steps.length ?? 0) > 0;
}

function startsOf(view: Known, offer: WayOffer): string {
	const texts = say().restart.ways;
	const { errand } = offer;
	if (isSoAlready(offer)) return say().restart.plan.already;
	const steps = (errand?.steps ?? []).map((step) => `${resourceTitle(view, step.resource)}: ${step.title}`);
	return steps.length === 0 ? texts.waitsOnly : `${few(texts, steps)}.`;
}

function few({ more }: Pick<Ways, 'more'>, all: readonly string[]): string {
	return all.length <= TOLD ? all.join(', ') : `${all.slice(0, TOLD - 1).join(', ')}, ${more(all.length - TOLD + 1)}`;
}
