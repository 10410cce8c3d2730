/** What a time line draws: a lane for each resource with what ran, and lanes for all else that happened. */
import type { TimeLine } from '#lib/contract.ts';
import type { Act } from '#lib/journal/acts.ts';
import { actText, actorText, subjectText } from '#lib/journal/wording.ts';
import { say } from '#lib/text/text.svelte.ts';
import type { Names } from './names.ts';
import { modeText, partOf, planWords, textsOf, told } from './told.ts';
import { shareOf, type Window } from '#lib/axis/window.ts';

/** Something that lasted. Without a number it began before the window; the end is open where it goes on. */
export interface Bar {
	readonly from: number;
	readonly to: number;
	readonly label: string;
	readonly number: number | null;
	readonly open: boolean;
}

/** Something that happened at once: a record, or an act of a person, which is found by its time. */
export interface Spot {
	readonly time: number;
	readonly label: string;
	readonly number: number | null;
	readonly act: Act | null;
	readonly refused: boolean;
}

export interface Lane {
	readonly id: string;
	readonly title: string;
	readonly bars: readonly Bar[];
	readonly spots: readonly Spot[];
}

const MODE_KINDS = new Set(['production-started', 'called-off', 'stepping-changed', 'step-taken', 'errand-taken', 'errand-stopped']);
const HAND_KINDS = new Set(['corrected', 'confirmed', 'forced', 'force-released', 'service-changed', 'by-hand']);

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
		byResource.set(of, [...(byResource.get(of) ?? []), ...bars.map((bar) => ({ ...bar, label }))]);
	}
	return [
		{ id: 'people', title: words.people, bars: [], spots: acts.map(actSpot) },
		{ id: 'mode', title: words.mode, bars: modesOf(line, window, until), spots: spots(MODE_KINDS) },
		{ id: 'plan', title: words.plan, bars: [], spots: plans },
		...[...byResource].map(([id, bars]) => ({ id: `of ${id}`, title: names.resource(id), bars, spots: [] })),
		{ id: 'hand', title: words.hand, bars: [], spots: spots(HAND_KINDS) },
		{ id: 'alarms', title: words.alarms, bars: [], spots: spots(new Set(['alarm'])) },
		{ id: 'controller', title: words.controller, bars: [], spots: spots(new Set(['begun'])) }
	];
}

function actSpot(act: Act): Spot {
	const { entry, time } = act.record;
	const on = subjectText(act.record);
	const refused = ['refused', 'failed'].includes((act.end ?? act.record).entry.outcome);
	const label = `${actorText(entry.actor)}: ${actText(entry.action)}${on === '' ? '' : `, ${on}`}`;
	return { time, label, number: null, act, refused };
}

/** When each ability ran. What had been started before the window begins with it, what did not end goes on. */
export function runsOf(line: TimeLine, window: Window, until: number): Map<string, Bar[]> {
	const runs = new Map<string, Bar[]>();
	const open = new Map<string, { from: number; number: number | null }>();
	const close = (ability: string, to: number, stays: boolean): void => {
		const begun = open.get(ability) ?? { from: window.from, number: null };
		open.delete(ability);
		const bar = { ...begun, to, label: ability, open: stays };
		runs.set(ability, [...(runs.get(ability) ?? []), bar]);
	};
	for (const ability of line.running) open.set(ability, { from: window.from, number: null });
	for (const { kind, content, time, number } of line.marks) {
		if (kind === 'begun') {
			for (const ability of [...open.keys()]) close(ability, time, true);
			continue;
		}
		for (const ability of [...textsOf(content['ended']), ...textsOf(content['called_off'])])
			if (open.has(ability)) close(ability, time, false);
		for (const ability of textsOf(content['started'])) {
			if (open.has(ability)) close(ability, time, true);
			open.set(ability, { from: time, number });
		}
	}
	const end = Math.min(window.to, Math.max(until, window.from));
	for (const ability of [...open.keys()]) close(ability, end, true);
	return runs;
}

/** The modes one after the other. */
function modesOf(line: TimeLine, window: Window, until: number): Bar[] {
	const bars: Bar[] = [];
	let last = line.mode === null ? null : { from: window.from, mode: line.mode, number: null as number | null };
	const end = Math.min(window.to, Math.max(until, window.from));
	const close = (to: number): void => {
		if (last !== null && to > last.from) bars.push({ from: last.from, to, label: modeText(last.mode), number: last.number, open: false });
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
