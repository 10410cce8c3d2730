/** What will be different, as sentences: one for each difference, with what follows from it. */
import type { BehaviourDifference, Comparison, Message, PartDifference } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';

export type Tag = 'changed' | 'new' | 'gone' | 'same' | 'open';
/** What a row is about: a symbol stands for it. */
export type About = 'limit' | 'length' | 'condition' | 'value' | 'action' | 'new' | 'gone' | 'plan' | 'proof' | 'open';
export type Changed = PartDifference['parts'][number];

export interface Row {
	readonly id: string;
	readonly about: About;
	readonly tag: Tag;
	/** The sentence, up to the values. */
	readonly lead: string;
	/** The values before and after, where they are short enough to stand in the sentence. */
	readonly was: string | null;
	readonly is: string | null;
	/** What follows from it, a sentence each. */
	readonly says: readonly string[];
	/** What is shown where somebody wants to see more: the properties, or runs. */
	readonly part: PartDifference | null;
	readonly properties: readonly Changed[];
	readonly runs: readonly (readonly string[])[];
}

/** How long runs of an ability took, in seconds. */
export type Measured = (ability: string) => readonly number[];

/** What people call an ability or an operation that is no part of a difference. */
export interface Titles {
	readonly ability: (name: string) => string;
	readonly operation: (name: string) => string;
}

/** Longer values do not stand in a sentence. */
const SHORT = 40;
const TIMES: Readonly<Record<string, About>> = {
	'must react within': 'limit',
	'must finish within': 'limit',
	'when it is late': 'limit',
	'usually takes': 'length',
	takes: 'length'
};
const VALUES = new Set(['priority', 'initial', 'values', 'task', 'kind', 'restart']);
const CONDITIONS = new Set(['enabled', 'start', 'executing', 'finished', 'finish', 'when', 'precondition', 'goal', 'local', 'forbidden', 'states of rest']);
const SUPERVISOR = new Set(['added by the supervisor', 'held back by the supervisor, among others']);
const LIMITS = new Set(['must react within', 'must finish within']);

/** One row for each difference; what is the same, and what nobody knows, comes last. */
export function rowsOf(result: Comparison, titles: Titles, measured: Measured): Row[] {
	const parts = (result.parts ?? []).toSorted((one, other) => rankOf(one) - rankOf(other));
	return [
		...parts.flatMap((part) => partRows(part, measured)),
		...(result.behaviour ?? []).flatMap((each) => startRows(each, titles)),
		...(result.plans ?? []).map((each) => planRow(each, titles)),
		...proofRows(result, titles)
	];
}

/** How many of the rows are differences. */
export function differencesIn(rows: readonly Row[]): number {
	return rows.filter(({ tag }) => tag !== 'same' && tag !== 'open').length;
}

/** What somebody has changed comes before what follows from it. */
function rankOf({ parts, state }: PartDifference): number {
	if (state !== 'changed') return 0;
	if (parts.every(({ part }) => SUPERVISOR.has(part))) return 2;
	return parts.some(({ part }) => part in TIMES) ? 0 : 1;
}

function row(id: string, about: About, tag: Tag, lead: string, more: Partial<Row> = {}): Row {
	return { id, about, tag, lead, was: null, is: null, says: [], part: null, properties: [], runs: [], ...more };
}

/** What people call a part that may stand for several. */
export function titleOf({ titles, name }: Pick<PartDifference, 'titles' | 'name'>): string {
	const [first] = titles;
	const title = first === undefined ? name : told(first, name);
	return titles.length > 1 ? say().review.different.instances(title, titles.length) : title;
}

function partRows(part: PartDifference, measured: Measured): Row[] {
	const texts = say().review.different;
	const id = part.members[0] ?? part.name;
	const title = titleOf(part);
	const kind = texts.kind[part.kind] ?? part.kind;
	if (part.state === 'new') return [row(`new ${id}`, 'new', 'new', texts.isNew(kind, title), { part, properties: part.parts })];
	if (part.state === 'gone') return [row(`gone ${id}`, 'gone', 'gone', texts.isGone(kind, title), { part, properties: part.parts })];
	return part.parts.map((changed) => changedRow(part, changed, title, measured));
}

function changedRow(part: PartDifference, changed: Changed, title: string, measured: Measured): Row {
	const { part: name, before, after } = changed;
	const [was, is] = [valueText(before, changed.before_message), valueText(after, changed.after_message)];
	const brief = !CONDITIONS.has(name) && !SUPERVISOR.has(name) && (was ?? '').length <= SHORT && (is ?? '').length <= SHORT;
	const tag: Tag = before === null ? 'new' : after === null ? 'gone' : 'changed';
	return row(`${part.members[0] ?? part.name} ${name}`, aboutOf(name), tag, leadOf(name, title, tag), {
		...(brief ? { was, is } : {}),
		says: saysOf(part, changed, measured),
		part,
		properties: brief ? [] : [changed]
	});
}

function aboutOf(property: string): About {
	if (VALUES.has(property)) return 'value';
	if (SUPERVISOR.has(property)) return 'proof';
	return TIMES[property] ?? (CONDITIONS.has(property) ? 'condition' : 'action');
}

function leadOf(name: string, title: string, tag: Tag): string {
	const texts = say().review.different;
	if (LIMITS.has(name) && tag === 'new') return texts.limitNew(title);
	if (LIMITS.has(name) && tag === 'gone') return texts.limitGone(title);
	if (name === 'usually takes' && tag === 'new') return texts.plannedNew(title);
	if (name === 'usually takes' && tag === 'gone') return texts.plannedGone(title);
	return texts.lead[name]?.(title) ?? texts.other(title, say().review.compare.parts[name] ?? name);
}

/** A value in the language of the page. */
export function valueText(written: string | null, message: Message | null): string | null {
	return written === null ? null : told(message, written);
}

function saysOf(part: PartDifference, changed: Changed, measured: Measured): string[] {
	const texts = say().review.different;
	const [before, after] = [secondsOf(changed.before_message), secondsOf(changed.after_message)];
	const runs = part.members.flatMap((member) => measured(member));
	if (LIMITS.has(changed.part)) {
		const late = changed.part === 'must finish within' && after !== null ? runs.filter((seconds) => seconds > after).length : 0;
		return [
			...(changed.after === null ? [texts.nobodyNow] : changed.before === null ? [texts.nobodyBefore] : []),
			...(before !== null && after !== null && after < before ? [texts.earlier(short(before - after))] : []),
			...(before !== null && after !== null && after > before ? [texts.later(short(after - before))] : []),
			...(changed.part === 'must finish within' ? measuredText(runs) : []),
			...(late > 0 ? [texts.wouldBeLate(late, runs.length)] : [])
		];
	}
	if (changed.part === 'usually takes') return measuredText(runs);
	if (changed.part === 'takes') return [texts.timesFollow];
	if (SUPERVISOR.has(changed.part)) return [texts.bySupervisor];
	return [
		...changed.added.map(({ sentence, text }) => texts.also(told(sentence, text))),
		...changed.dropped.map(({ sentence, text }) => texts.noLonger(told(sentence, text)))
	];
}

function measuredText(runs: readonly number[]): string[] {
	if (runs.length === 0) return [];
	return [say().review.different.measured(runs.length, short(Math.min(...runs)), short(Math.max(...runs)))];
}

/** Seconds to a tenth, without one that is none. */
export function short(seconds: number): string {
	return new Intl.NumberFormat(say().locale, { maximumFractionDigits: 1 }).format(seconds);
}

function secondsOf(message: Message | null): number | null {
	const seconds = message?.id === 'compare.seconds' ? message.arguments?.['seconds'] : null;
	return typeof seconds === 'number' ? seconds : null;
}

function startRows({ ability, gains, gained, loses, lost }: BehaviourDifference, titles: Titles): Row[] {
	const texts = say().review.different;
	const title = titles.ability(ability);
	const said = (run: readonly string[] | null): string => (run === null ? texts.noRun : run.length === 0 ? texts.fromBeginning : texts.run(run.length));
	const rowFor = (tag: Tag, lead: string, run: readonly string[] | null): Row =>
		row(`${tag} start ${ability}`, 'condition', tag, lead, { says: [said(run)], runs: run === null || run.length === 0 ? [] : [run.map(titles.ability)] });
	return [
		...(gains === true ? [rowFor('new', texts.startsGained(title), gained)] : []),
		...(loses === true ? [rowFor('changed', texts.startsLost(title), lost)] : [])
	];
}

function planRow({ operation, before, after }: NonNullable<Comparison['plans']>[number], titles: Titles): Row {
	const texts = say().review.different;
	const starts = (run: readonly string[] | null): string => (run === null ? texts.noPlan : texts.starts(run.length));
	return row(`plan ${operation}`, 'plan', before === null ? 'new' : after === null ? 'gone' : 'changed', texts.plan(titles.operation(operation)), {
		was: starts(before),
		is: starts(after),
		runs: [before, after].filter((run) => run !== null).map((run) => run.map(titles.ability))
	});
}

/** What was proven to be the same, and what could not be. */
function proofRows({ behaviour, undecided, guards, unplanned, text }: Comparison, titles: Titles): Row[] {
	const texts = say().review.different;
	if (behaviour === null || undecided === null || Object.keys(text).length === 0) return [];
	const supervised = guards === null ? [] : [guards[0] === guards[1] ? texts.sameGuards(guards[1]) : texts.otherGuards(guards[0], guards[1])];
	const open = unplanned === null || unplanned.length === 0 ? [] : [texts.unplanned(unplanned.length)];
	if (undecided.length > 0) {
		const names = listed(undecided.map(titles.ability));
		return [row('undecided', 'open', 'open', texts.undecided, { says: [texts.undecidedSaid(names), ...supervised, ...open] })];
	}
	if (behaviour.length === 0) return [row('same', 'proof', 'same', texts.sameStarts, { says: [texts.sameStartsSaid, ...supervised, ...open] })];
	return open.length === 0 ? [] : [row('unplanned', 'open', 'open', texts.unplanned(unplanned?.length ?? 0), { says: supervised })];
}

/** Names of many, the first of them. */
function listed(names: readonly string[]): string {
	const MOST = 5;
	const more = names.length - MOST;
	return `${names.slice(0, MOST).join(', ')}${more > 0 ? `, ${say().common.more(more)}` : ''}`;
}
