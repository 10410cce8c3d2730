/** A record of the run in words: what happened, on what, by whom and why. */
import type { Alarm, Message } from '#lib/contract.ts';
import { titleOf as orderTitle } from '#lib/orders/orders.ts';
import { leading, told as said, wordsOf } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { plain } from '#lib/wording/values.ts';
import type { Names } from './names.ts';

export interface Told {
	readonly what: string;
	readonly on: string;
	readonly who: string;
	readonly why: string;
	readonly outcome: string;
	/** Where several things happened at once, each by itself. */
	readonly several?: readonly string[];
}

/** A record, or a mark of the time line, which has less of its content. */
export interface Tellable {
	readonly kind: string;
	readonly content: Readonly<Record<string, unknown>>;
	readonly plan_message?: Message | null;
}

type Content = Readonly<Record<string, unknown>>;

/** How many names are said of a list; of the others how many there are. */
const NAMED = 4;

/** The parts of a tick that people want to know, each with what its names are of. */
const DEEDS = [
	['started', 'ability'],
	['ended', 'ability'],
	['activated', 'operation'],
	['completed', 'operation'],
	['called_off', 'ability'],
	['given_up', 'ability']
] as const;

export function told(record: Tellable, names: Names): Told {
	const { kind, content } = record;
	const reason = said(record.plan_message, textOf(partOf(content, 'plan')?.['reason']));
	const what = partOf(content, 'what') ?? content;
	const nothing = { on: '', who: textOf(what['by']), why: textOf(what['why']), outcome: '' };
	const words = say().history.words;
	switch (kind) {
		case 'begun':
			return { ...nothing, what: words.begun };
		case 'snapshot':
			return { ...nothing, what: words.snapshot };
		case 'ticked':
			return { ...nothing, ...tick(content, reason, names) };
		case 'asked':
			return { ...nothing, what: what['contract'] === 'minimal' ? words.askedBetter : words.asked };
		case 'answered':
			return { ...nothing, ...answered(content, what, reason) };
		case 'unanswered':
			return { ...nothing, what: planWords(content) ?? words.unanswered };
		case 'explained':
			return { ...nothing, what: words.explained };
		case 'production-started':
			return { ...nothing, what: words.production };
		case 'mode-changed':
			return { ...nothing, what: words.mode, on: modeText(what['mode']) };
		case 'called-off':
			return { ...nothing, what: words.calledOff };
		case 'cycle-stop-changed':
			return { ...nothing, what: words.cycleStop, on: what['on'] === true ? words.on : words.off };
		case 'stepping-changed':
			return { ...nothing, what: words.stepping, on: what['on'] === true ? words.on : words.off };
		case 'step-taken':
			return { ...nothing, what: words.step };
		case 'service-changed':
			return {
				...nothing,
				what: words.service,
				on: served(textOf(what['of']), textOf(what['name']), names),
				outcome: what['in_service'] === true ? words.inService : words.outOfService
			};
		case 'corrected':
			return { ...nothing, what: words.corrected, on: settings(partOf(what, 'values') ?? {}, names) };
		case 'confirmed':
			return { ...nothing, what: words.confirmed, on: list(textsOf(what['names']).map(names.variable)) };
		case 'forced':
			return { ...nothing, what: words.forced, on: setting(textOf(what['name']), what['value'], names) };
		case 'force-released':
			return { ...nothing, what: words.released, on: names.variable(textOf(what['name'])) };
		case 'by-hand':
			return { ...nothing, ...byHand(what, names) };
		case 'errand-taken': {
			const errand = partOf(what, 'errand') ?? what;
			return { ...nothing, what: words.errand, who: textOf(errand['by']), why: textOf(errand['why']) };
		}
		case 'errand-stopped':
			return { ...nothing, what: words.errandStopped };
		case 'by-order-changed':
			return { ...nothing, what: words.byOrder, on: what['on'] === true ? words.on : words.off };
		case 'job-taken':
			return { ...nothing, what: words.jobTaken, on: textOf(what['title']) || textOf(what['job']) };
		case 'jobs-sequenced':
			return { ...nothing, what: words.jobsSequenced };
		case 'job-commanded':
			return { ...nothing, what: words.jobTold[textOf(what['act'])] ?? '', on: orderTitle({ id: textOf(what['job']), description: '' }) };
		case 'job-forgotten':
			return { ...nothing, what: words.jobForgotten, on: orderTitle({ id: textOf(what['job']), description: '' }) };
		case 'alarm':
			return { ...nothing, ...alarmed(what as unknown as Alarm), what: words.alarm[textOf(what['event'])] ?? textOf(what['event']), outcome: priorityOf(textOf(what['priority'])) };
		case 'alarms-aside':
			return { ...nothing, what: words.aside };
		case 'beliefs':
			return { ...nothing, what: words.beliefs };
		case 'operations':
			return { ...nothing, what: words.progress };
		default:
			return { ...nothing, what: plain(kind.replaceAll('-', ' ')) };
	}
}

/** What happened and to what. Of several things at once each is named before what it was done to. */
export function titleOf({ what, on }: Told): string {
	if (on === '') return what;
	return on.startsWith(`${what.split(', ')[0]}: `) ? on : `${what}: ${on}`;
}

/** What happened, each thing by itself. */
export function factsOf(told: Told): readonly string[] {
	return told.several ?? [titleOf(told)];
}

/** What changed that nothing commanded, or by which ability the station then went on. */
function byHand(what: Content, names: Names): Partial<Told> & { what: string } {
	const words = say().history.words;
	const ability = textOf(what['by_ability']);
	const how = words.wentOn[textOf(what['how'])];
	const outcome = ability === '' || how === undefined ? '' : how(names.ability(ability));
	const changed = partOf(what, 'changed');
	if (changed === null) return { what: words.movedOn, on: names.resource(textOf(what['resource'])), outcome };
	const on = Object.entries(changed).map(([name, values]) => {
		const [before, after] = Array.isArray(values) ? values : [null, values];
		return `${names.variable(name)}: ${names.value(name, before)} → ${names.value(name, after)}`;
	});
	return { what: words.moved, on: list(on), outcome };
}

/** What is said of the plan from a record on; null where it says nothing of it. */
export function planWords(content: Content): string | null {
	const plan = partOf(content, 'plan');
	if (plan === null) return null;
	const words = say().history.words;
	if (plan['replaced'] === true) return words.planReplaced;
	switch (plan['status']) {
		case 'followed':
			return words.planMade;
		case 'broken':
			return words.planBroken;
		case 'none':
			return words.planNone;
		case 'idle':
			return words.planIdle;
		default:
			return words.planSought;
	}
}

function tick(content: Content, why: string, names: Names): Partial<Told> & { what: string } {
	const words = say().history.words;
	const done = DEEDS.flatMap(([part, of]) => {
		const ids = textsOf(content[part]);
		return ids.length === 0 ? [] : [{ what: words[part], on: list(ids.map(names[of])) }];
	});
	const plan = planWords(content);
	if (plan !== null) done.push({ what: plan, on: '' });
	const [first] = done;
	if (first === undefined) {
		const heard = partOf(content, 'measured');
		return { what: heard === null ? words.ticked : words.heard, on: settings(heard ?? {}, names) };
	}
	if (done.length === 1) return { ...first, why, several: factsIn(content, names) };
	const several = done.filter((each) => each.on !== '').map((each) => `${each.what}: ${each.on}`);
	return { what: done.map((each) => each.what).join(', '), on: several.join(' · '), why, several: factsIn(content, names) };
}

/** Of what is said of an operation, what is said of an ability of the same name as well. */
const SAID_BY = { ended: 'completed', activated: 'started' } as const;

/** What a tick did, each to one thing: that a task ended is not said where the operation of its name is completed by it. */
function factsIn(content: Content, names: Names): string[] {
	const words = say().history.words;
	const named = (part: string): string[] => {
		const of = DEEDS.find(([each]) => each === part)?.[1];
		return of === undefined ? [] : textsOf(content[part]).map(names[of]);
	};
	const facts = DEEDS.flatMap(([part]) => {
		const other = part === 'ended' || part === 'activated' ? named(SAID_BY[part]) : [];
		const own = named(part).filter((name) => !other.includes(name));
		const more = own.length - NAMED;
		const shown = more > 1 ? own.slice(0, NAMED) : own;
		return [...shown.map((name) => `${words[part]}: ${name}`), ...(more > 1 ? [`${words[part]}: ${words.and(more)}`] : [])];
	});
	const plan = planWords(content);
	return plan === null ? facts : [...facts, plan];
}

/** Of an alarm that came what leads is what came, and the rest what is told of it. */
function alarmed(alarm: Alarm): Pick<Told, 'on' | 'why'> {
	const [on, why] = leading(wordsOf(alarm).text);
	return { on, why };
}

function answered(content: Content, what: Content, why: string): Partial<Told> & { what: string } {
	const words = say().history.words;
	const found = partOf(partOf(what, 'answer') ?? {}, 'plan');
	const ticks = Array.isArray(found?.['ticks']) ? found['ticks'] : [];
	const starts = ticks.reduce((sum: number, each: unknown) => sum + startsOf(each), 0);
	const plan = planWords(content);
	const length = 'answer' in what ? (found === null ? words.noPlan : words.starts(starts)) : '';
	// That there is no plan is said once.
	return { what: plan ?? words.answered, why, outcome: found === null && plan === words.planNone ? '' : length };
}

function startsOf(tick: unknown): number {
	return typeof tick === 'object' && tick !== null && 'starts' in tick ? textsOf(tick.starts).length : 0;
}

/** What is in service or out of it, by its title. */
export function served(of: string, name: string, names: Pick<Names, 'resource' | 'operation' | 'ability'>): string {
	if (of === 'resource') return names.resource(name);
	return of === 'operation' ? names.operation(name) : names.ability(name);
}

/** `Pose: home`, of what has another value. */
function setting(name: string, value: unknown, names: Names): string {
	return `${names.variable(name)}: ${names.value(name, value)}`;
}

function settings(values: Content, names: Names): string {
	return list(Object.entries(values).map(([name, value]) => setting(name, value, names)));
}

export function modeText(mode: unknown): string {
	const name = textOf(mode);
	const names = say().frame.mode;
	return Object.hasOwn(names, name) ? names[name as keyof typeof names] : name;
}

function list(all: readonly string[]): string {
	const rest = all.length - NAMED;
	return rest > 1 ? `${all.slice(0, NAMED).join(', ')} ${say().history.words.and(rest)}` : all.join(', ');
}

function textOf(value: unknown): string {
	return typeof value === 'string' ? value : '';
}

export function textsOf(value: unknown): string[] {
	return Array.isArray(value) ? value.filter((each) => typeof each === 'string') : [];
}

/** What a part of a document holds, where that is a document itself. */
export function partOf(content: Content, name: string): Content | null {
	const part = content[name];
	return typeof part === 'object' && part !== null && !Array.isArray(part) ? (part as Content) : null;
}

/** How urgent an alarm was, as the page says it. */
function priorityOf(priority: string): string {
	return Object.entries(say().alarms.priorityOf).find(([name]) => name === priority)?.[1] ?? priority;
}
