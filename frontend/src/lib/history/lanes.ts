/** What a time line draws: lanes for the mode, the operations, each resource with what ran, and all else that happened. */
import { initialsOf } from '#lib/account/initials.ts';
import type { Alarm, Priority, TimeLine } from '#lib/contract.ts';
import type { Act } from '#lib/journal/acts.ts';
import { actText, actorText, subjectText } from '#lib/journal/wording.ts';
import { leading, wordsOf } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { shareOf, type Window } from '#lib/axis/window.ts';
import type { Names } from './names.ts';
import { modeText, partOf, planWords, textsOf, told } from './told.ts';

/** Something that lasted. Without a number it began before the window; the end is open where it goes on. */
export interface Bar {
	readonly from: number;
	readonly to: number;
	readonly label: string;
	readonly number: number | null;
	readonly open: boolean;
	/** It was called off, as it did not end in time; or its device did not go on. */
	readonly failed?: boolean;
	/** What was wrong with its device meanwhile, in a few words. */
	readonly cause?: string;
	/** How urgent that was. */
	readonly priority?: Priority;
	/** It is not as usual: not the mode in which the station works by itself. */
	readonly other?: boolean;
	/** What ran. */
	readonly ability?: string;
}

/** Something that happened at once: a record, or an act of a person, which is found by its time. */
export interface Spot {
	readonly time: number;
	readonly label: string;
	readonly number: number | null;
	readonly act: Act | null;
	readonly refused: boolean;
	/** The letters of a person, or the priority of an alarm that came. */
	readonly by?: string;
	readonly alarm?: Priority;
}

export interface Lane {
	readonly id: string;
	readonly title: string;
	/** Whose lane it is, where it is that of a resource. */
	readonly resource?: string;
	readonly bars: readonly Bar[];
	readonly spots: readonly Spot[];
}

/** What is of plans, beside their own records. */
const PLAN_KINDS = new Set(['begun', 'errand-taken', 'errand-stopped']);
/** What goes with the acts of people: what they are about, and what the station has noticed by itself. */
const PEOPLE_KINDS = new Set(['production-started', 'called-off', 'cycle-stop-changed', 'stepping-changed', 'step-taken', 'by-hand']);
/** What is told of an alarm that wants attention from then on. */
const TELLS: ReadonlySet<unknown> = new Set(['came', 'came again', 'became more urgent', 'stands by itself']);
const PRIORITIES: readonly unknown[] = ['high', 'medium', 'low'] satisfies Priority[];

/** What is drawn, and how: `resources` have a lane each, in their order; what goes on is drawn up to `until`. */
export interface Drawing {
	readonly window: Window;
	readonly until: number;
	readonly resources: readonly string[];
	readonly names: Names;
}

/** The lanes of a line, with the acts of people in it. */
export function lanesOf(
	line: TimeLine,
	acts: readonly Act[],
	{ window, until, resources, names }: Drawing
): Lane[] {
	const words = say().history.line;
	const spots = (kinds: ReadonlySet<string>): Spot[] =>
		line.marks
			.filter((mark) => kinds.has(mark.kind))
			.map((mark) => {
				const { what, on } = told(mark, names);
				return { time: mark.time, label: on === '' ? what : `${what}: ${on}`, number: mark.number, act: null, refused: false };
			});
	const plans = line.marks.flatMap((mark): Spot[] => {
		const label = planWords(mark.content);
		return label === null ? [] : [{ time: mark.time, label, number: mark.number, act: null, refused: false }];
	});
	const runs = line.whole ? runsOf(line, window, until) : new Map<string, Bar[]>();
	const byResource = new Map<string, Bar[]>(resources.map((id) => [id, []]));
	for (const [ability, bars] of runs) {
		const of = names.resourceOf(ability);
		const label = names.ability(ability);
		byResource.set(of, [...(byResource.get(of) ?? []), ...bars.map((bar) => ({ ...bar, label, ability }))]);
	}
	for (const [id, bars] of byResource) byResource.set(id, broken(bars, troublesOf(line, window, id)));
	const operations = line.whole ? operationsOf(line, window, until) : [];
	return [
		{ id: 'mode', title: words.mode, bars: modesOf(line, window, until), spots: [] },
		{ id: 'operations', title: words.operations, bars: operations.map((bar) => ({ ...bar, label: names.operation(bar.label) })), spots: [] },
		...[...byResource].map(([id, bars]) => ({ id: `of ${id}`, title: names.resource(id), resource: id, bars, spots: [] })),
		{ id: 'plan', title: words.plan, bars: [], spots: [...plans, ...spots(PLAN_KINDS)] },
		{ id: 'people', title: words.people, bars: [], spots: [...acts.map((act) => actSpot(act, names)), ...spots(PEOPLE_KINDS), ...alarmsOf(line, names)] }
	];
}

/** Kinds of alarms that tell that a device does not go on, or that nothing is heard of it. */
const BROKEN: ReadonlySet<unknown> = new Set(['overdue', 'still', 'given-up', 'silent']);

interface Trouble {
	readonly time: number;
	readonly cause: string;
	readonly priority: Priority;
	/** What of the resource did not go on, where that is told. */
	readonly ability: string | null;
}

/** When a device of a resource did not go on, and what was told of it; what stood at the beginning of the window was so then. */
function troublesOf({ alarms, marks }: TimeLine, { from }: Window, resource: string): Trouble[] {
	const stood = alarms.map((mark) => ({ ...mark, time: Math.max(mark.time, from) }));
	const came = marks.filter(({ kind, content }) => kind === 'alarm' && TELLS.has((partOf(content, 'what') ?? content)['event']));
	return [...stood, ...came].flatMap(({ time, content }) => {
		const what = partOf(content, 'what') ?? content;
		if (!BROKEN.has(what['kind']) || !textsOf(what['resources']).includes(resource)) return [];
		const alarm = what as unknown as Alarm;
		const ability = alarm.kind === 'overdue' ? alarm.subject : null;
		return [{ time, cause: leading(wordsOf(alarm).text)[0], priority: alarm.priority, ability }];
	});
}

/** What ran when its device did not go on, marked so: of several at once what is told of, else what was started last. */
function broken(bars: readonly Bar[], troubles: readonly Trouble[]): Bar[] {
	const found = new Map<Bar, Trouble>();
	for (const trouble of troubles) {
		const { time, ability } = trouble;
		const ran = bars.filter(({ from, to }) => from <= time && time <= to).sort((a, b) => b.from - a.from);
		const bar = ran.find((each) => each.ability === ability) ?? ran[0];
		if (bar) found.set(bar, trouble);
	}
	return bars.map((bar) => {
		const trouble = found.get(bar);
		return trouble ? { ...bar, failed: true, cause: trouble.cause, priority: trouble.priority } : bar;
	});
}

function actSpot(act: Act, names: Names): Spot {
	const { entry, time } = act.record;
	const on = subjectText(act.record, names);
	const refused = ['refused', 'failed'].includes((act.end ?? act.record).entry.outcome);
	const label = `${actorText(entry.actor)}: ${actText(entry.action)}${on === '' ? '' : `, ${on}`}`;
	return { time, label, number: null, act, refused, by: initialsOf(entry.actor.name) };
}

/** The alarms of a line; those that came, again or more urgent, have their priority. */
export function alarmsOf(line: Pick<TimeLine, 'marks'>, names: Names): Spot[] {
	return line.marks
		.filter(({ kind }) => kind === 'alarm')
		.map((mark) => {
			const { what, on } = told(mark, names);
			const found = mark.content['priority'] ?? partOf(mark.content, 'what')?.['priority'];
			const event = mark.content['event'] ?? partOf(mark.content, 'what')?.['event'];
			const spot: Spot = { time: mark.time, label: on === '' ? what : `${what}: ${on}`, number: mark.number, act: null, refused: false };
			return TELLS.has(event) && PRIORITIES.includes(found) ? { ...spot, alarm: found as Priority } : spot;
		});
}

/** When each ability ran. What had been started before the window begins with it, what did not end goes on. */
export function runsOf(line: TimeLine, window: Window, until: number): Map<string, Bar[]> {
	const runs = new Map<string, Bar[]>();
	const open = new Map<string, { from: number; number: number | null }>();
	const close = (ability: string, to: number, stays: boolean, failed = false): void => {
		const begun = open.get(ability) ?? { from: window.from, number: null };
		open.delete(ability);
		const bar = { ...begun, to, label: ability, open: stays, ...(failed ? { failed } : {}) };
		runs.set(ability, [...(runs.get(ability) ?? []), bar]);
	};
	for (const ability of line.running) open.set(ability, { from: window.from, number: null });
	for (const { kind, content, time, number } of line.marks) {
		if (kind === 'begun') {
			for (const ability of [...open.keys()]) close(ability, time, true);
			continue;
		}
		for (const ability of textsOf(content['ended'])) if (open.has(ability)) close(ability, time, false);
		// A tick calls off what is overdue, any other record what a person has stopped.
		for (const ability of textsOf(content['called_off']))
			if (open.has(ability)) close(ability, time, false, kind === 'ticked');
		for (const ability of textsOf(content['started'])) {
			if (open.has(ability)) close(ability, time, true);
			open.set(ability, { from: time, number });
		}
		// What only does something at its start is over with it.
		for (const ability of textsOf(content['at_once'])) if (open.has(ability)) close(ability, time, false);
	}
	const end = Math.min(window.to, Math.max(until, window.from));
	for (const ability of [...open.keys()]) close(ability, end, true);
	return runs;
}

/** When each operation was active. */
function operationsOf(line: TimeLine, window: Window, until: number): Bar[] {
	const bars: Bar[] = [];
	const open = new Map<string, { from: number; number: number | null }>();
	for (const name of line.active) open.set(name, { from: window.from, number: null });
	for (const { content, time, number } of line.marks) {
		for (const name of textsOf(content['completed'])) {
			const begun = open.get(name);
			if (begun !== undefined) bars.push({ ...begun, to: time, label: name, open: false });
			open.delete(name);
		}
		for (const name of textsOf(content['activated'])) open.set(name, { from: time, number });
	}
	const end = Math.min(window.to, Math.max(until, window.from));
	for (const [name, begun] of open) bars.push({ ...begun, to: end, label: name, open: true });
	return bars.sort((a, b) => a.from - b.from);
}

/** The modes one after the other. */
function modesOf(line: TimeLine, window: Window, until: number): Bar[] {
	const bars: Bar[] = [];
	let last = line.mode === null ? null : { from: window.from, mode: line.mode, number: null as number | null };
	const end = Math.min(window.to, Math.max(until, window.from));
	const close = (to: number): void => {
		if (last !== null && to > last.from)
			bars.push({ from: last.from, to, label: modeText(last.mode), number: last.number, open: false, other: last.mode !== 'automatic' });
	};
	for (const { content, time, number } of line.marks) {
		const mode = content['mode'] ?? partOf(content, 'what')?.['mode'];
		if (typeof mode !== 'string' || mode === last?.mode) continue;
		close(time);
		last = { from: time, mode, number };
	}
	close(end);
	return bars;
}

/** Rows of a lane at most; what would need another one is drawn in the last, without words. */
export const MOST_ROWS = 3;

export interface Placed<B extends Bar = Bar> {
	readonly bar: B;
	readonly row: number;
	/** There is no room for its words: another one is there. */
	readonly crowded: boolean;
}

/**
 * Bars that last at the same time one below the other; each takes `least` seconds of its row. What has stopped or has not
 * ended has its words rather than what has.
 */
export function placed<B extends Bar>(bars: readonly B[], least = 0, most = MOST_ROWS): { readonly rows: number; readonly all: readonly Placed<B>[] } {
	const rows: { end: number; last: { bar: B; row: number; crowded: boolean } }[] = [];
	const all: { bar: B; row: number; crowded: boolean }[] = [];
	for (const bar of [...bars].sort((a, b) => a.from - b.from)) {
		const free = rows.findIndex(({ end }) => end <= bar.from);
		const place = { bar, row: free >= 0 ? free : Math.min(rows.length, most - 1), crowded: free < 0 && rows.length === most };
		const yielding = place.crowded && lasts(bar) ? rows.findLastIndex(({ last }) => !lasts(last.bar)) : -1;
		const other = rows[yielding];
		if (other) {
			other.last.crowded = true;
			Object.assign(place, { row: yielding, crowded: false });
		}
		all.push(place);
		const end = Math.max(rows[place.row]?.end ?? -Infinity, bar.to, bar.from + least);
		if (!place.crowded) rows[place.row] = { end, last: place };
		else if (least === 0) rows[place.row] = { end, last: rows[place.row]?.last ?? place };
	}
	return { rows: Math.max(1, rows.length), all };
}

/** Whether something has stopped, or goes on. */
function lasts({ failed, open }: Bar): boolean {
	return failed === true || open;
}

/** What is nearest to a time in a lane, at most `reach` seconds away: something that began or happened there. */
export function nearest(lane: Lane, time: number, reach: number): { time: number; number: number | null; act: Act | null } | null {
	const begun = lane.bars.flatMap((bar) =>
		bar.number !== null && time >= bar.from - reach && time <= bar.to + reach
			? [{ time: bar.from, number: bar.number, act: null, away: 0 }]
			: []
	);
	const all = [...lane.spots.map((spot) => ({ ...spot, away: Math.abs(spot.time - time) })), ...begun];
	const [best] = all.filter(({ away }) => away <= reach).sort((a, b) => a.away - b.away);
	return best ?? null;
}

/** Spots that would stand on one another as one: those nearer than `share` of the window to the first of them. */
export function gathered(spots: readonly Spot[], window: Window, share: number): Spot[][] {
	const sorted = [...spots].sort((a, b) => a.time - b.time);
	const groups: Spot[][] = [];
	for (const spot of sorted) {
		const group = groups.at(-1);
		const first = group?.[0];
		if (group && first && shareOf(window, spot.time) - shareOf(window, first.time) < share) group.push(spot);
		else groups.push([spot]);
	}
	return groups;
}
