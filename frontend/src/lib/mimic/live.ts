/** What the picture shows of the station as it is: pure functions of the two. */
import type { Alarm, MimicPart, MimicSymbol, MimicTest, MimicText, MimicTrack, Priority, StationView, Value } from '#lib/contract.ts';
import { NUMBER, isOver, isTold, type Keyed } from '#lib/alarm/priority.ts';
import { inLanguage } from '#lib/text/text.svelte.ts';
import { valueText } from '#lib/wording/values.ts';

export type Variables = StationView['variables'];
export type Look = MimicPart['looks'][string] | 'doubt';

/** The value of a variable; null where it is unknown or there is none. */
export function valueOf(variables: Variables, name: string): Value | null {
	return Object.hasOwn(variables, name) ? (variables[name]?.value ?? null) : null;
}

/** The value of a variable, or the last that was known of it. */
function lastOf(variables: Variables, name: string): Value | null {
	return valueOf(variables, name) ?? (Object.hasOwn(variables, name) ? (variables[name]?.last_known ?? null) : null);
}

/** Whether all tests hold; null where unknown values leave it open. */
export function holds(tests: readonly MimicTest[], variables: Variables): boolean | null {
	let open = false;
	for (const { variable, values } of tests) {
		const value = valueOf(variables, variable);
		if (value === null) open = true;
		else if (!values.includes(value)) return false;
	}
	return open ? null : true;
}

/** The first text that is to be said, with its values; empty where none is. */
export function saidOf(texts: readonly MimicText[], variables: Variables, language: string): string {
	const said = texts.find(({ when }) => holds(when, variables) === true);
	return said === undefined ? '' : withValues(inLanguage(said.text, language), variables);
}

/** A text with the values of the variables in braces. */
export function withValues(text: string, variables: Variables): string {
	return text.replaceAll(/\{([^{}]*)\}/g, (_, name: string) => {
		const value = valueOf(variables, name);
		return value === null ? '?' : valueText(value);
	});
}

/** How a part looks. What nobody has confirmed looks as it is believed to be; what is unknown is in doubt. */
export function lookOf(part: MimicPart, variables: Variables): Look {
	const value = valueOf(variables, part.variable);
	return value === null ? 'doubt' : (part.looks[String(value)] ?? 'doubt');
}

export interface Whereabouts {
	/** The stop at which it is, or was last. */
	readonly from: string;
	/** The stop to which it is under way, or was when it was last heard; the same where it stands. */
	readonly to: string;
	/** `moving`: between two stops; `doubt`: nobody knows. */
	readonly kind: 'there' | 'moving' | 'doubt';
}

/** Where something is on its track; `last` is where it was seen before. */
export function whereabouts(track: MimicTrack, variables: Variables, last: string | null): Whereabouts | null {
	const isStop = (value: Value | null): value is string => track.stops.some((stop) => stop.value === value);
	const position = valueOf(variables, track.position);
	const target = track.target === null ? null : valueOf(variables, track.target);
	const previous = track.previous === null ? null : lastOf(variables, track.previous);
	if (isStop(position)) return { from: position, to: position, kind: 'there' };
	const known = lastOf(variables, track.position);
	// It stood there when it was heard last.
	if (position === null && isStop(known)) return { from: known, to: known, kind: 'doubt' };
	// It was under way then, and what it was told to do was told before.
	if (position === null && known !== null && isStop(previous)) return { from: previous, to: isStop(target) ? target : previous, kind: 'doubt' };
	// Where nothing is heard of it, and nobody knows where it was, it is drawn at no stop: it may never have been there.
	if (position === null && !isStop(previous) && last === null) return null;
	const to = isStop(target) ? target : null;
	const from = isStop(previous) ? previous : (last ?? onlyNeighbour(track, to));
	if (from === null && to === null) return null;
	const kind = position === null ? 'doubt' : 'moving';
	return { from: from ?? to ?? '', to: kind === 'doubt' ? (from ?? to ?? '') : (to ?? from ?? ''), kind };
}

/** The stop from which alone another is reached. */
function onlyNeighbour(track: MimicTrack, stop: string | null): string | null {
	const found = track.ways.filter((way) => stop !== null && way.includes(stop)).map(([a, b]) => (a === stop ? b : a));
	return found.length === 1 ? (found[0] ?? null) : null;
}

/** The stop to which it was sent and where it is not yet; null where it is there. */
export function sentTo(track: MimicTrack, variables: Variables): string | null {
	const target = track.target === null ? null : valueOf(variables, track.target);
	const found = track.stops.find((stop) => stop.value === target);
	return found === undefined || found.value === valueOf(variables, track.position) ? null : found.value;
}

/** The alarms of a resource that last, the most urgent first. */
export function alarmsOf(alarms: StationView['alarms'], resource: string | null): Keyed[] {
	return Object.entries(alarms)
		.filter(([, alarm]) => isTold(alarm) && !isOver(alarm) && resource !== null && alarm.resources.includes(resource))
		.sort(([, a], [, b]) => NUMBER[a.priority] - NUMBER[b.priority] || b.since - a.since);
}

/** The most urgent of alarms. */
export function worst(alarms: readonly (readonly [string, Alarm])[]): Priority | null {
	return alarms[0]?.[1].priority ?? null;
}

/** How full something is, from 0 to 1; null where it is unknown. */
export function levelOf(symbol: Pick<MimicSymbol, 'level'>, variables: Variables): number | null {
	if (symbol.level === null) return null;
	const value = valueOf(variables, symbol.level.variable);
	const { lowest, highest } = symbol.level;
	return typeof value !== 'number' ? null : highest === lowest ? 1 : (value - lowest) / (highest - lowest);
}
