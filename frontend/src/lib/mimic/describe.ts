/** What is said of a thing in the picture, in words. */
import type { MimicSymbol, MimicTrack, StationView } from '#lib/contract.ts';
import type { Doing } from '#lib/resource/doing.ts';
import { say } from '#lib/text/text.svelte.ts';
import { plain, valueText, variableName } from '#lib/wording/values.ts';
import { holds, inLanguage, saidOf, sentTo, valueOf, whereabouts, type Variables } from './live.ts';

export interface Now {
	readonly text: string;
	/** `doubt`: it is not known. */
	readonly tone: 'rests' | 'active' | 'doubt';
}

/** What a thing is called. */
export function nameOf(symbol: MimicSymbol, resources: StationView['resources'], language: string): string {
	const own = inLanguage(symbol.title, language);
	if (own !== '') return own;
	if (symbol.resource === null) return say().mimic.product;
	return resources[symbol.resource]?.title ?? plain(symbol.resource);
}

/** What a stop is called. */
export function stopName(track: MimicTrack, value: string, language: string): string {
	const title = track.stops.find((stop) => stop.value === value)?.title ?? {};
	return inLanguage(title, language) || plain(value);
}

/** What a thing does or is. */
export function nowOf(symbol: MimicSymbol, view: StationView, doing: Doing | undefined, language: string): Now {
	const texts = say().mimic;
	const { variables, tasks } = view;
	const resource = symbol.resource;
	if (resource !== null && view.resources[resource]?.online === false) return { text: texts.notHeard, tone: 'doubt' };
	const running = doing?.running ?? [];
	const active = running.length > 0 || (symbol.active.length > 0 && holds(symbol.active, variables) === true);
	const tone = active ? 'active' : 'rests';
	if (symbol.track !== null) return whereNow(symbol.track, variables, active, language);
	if (symbol.symbol === 'person') {
		const task = Object.values(tasks).find((each) => each.resource === resource);
		if (task !== undefined) return { text: task.title, tone: 'active' };
	}
	const said = saidOf(symbol.texts, variables, language);
	if (active && running[0] !== undefined && (said === '' || symbol.active.length === 0)) return { text: running[0].title, tone };
	if (said !== '') return { text: said, tone };
	const key = keyOf(resource, variables);
	if (key === null) return { text: resource === null || symbol.parts.length > 0 ? '' : texts.rests, tone };
	const value = valueOf(variables, key);
	const told = value === null ? say().common.unknown : valueText(value);
	return { text: texts.is(variableName(key, resource), told), tone: value === null ? 'doubt' : tone };
}

function whereNow(track: MimicTrack, variables: Variables, active: boolean, language: string): Now {
	const texts = say().mimic;
	const at = whereabouts(track, variables, null);
	if (valueOf(variables, track.position) === null) return { text: texts.unknownPlace, tone: 'doubt' };
	const target = sentTo(track, variables);
	if (at === null || (at.kind === 'moving' && target === null)) return { text: texts.between, tone: 'active' };
	const stop = capitalised(stopName(track, at.kind === 'moving' ? (target ?? at.to) : at.to, language));
	return at.kind === 'moving' ? { text: texts.towards(stop), tone: 'active' } : { text: stop, tone: active ? 'active' : 'rests' };
}

function capitalised(text: string): string {
	return text.slice(0, 1).toUpperCase() + text.slice(1);
}

/** The variable that says most of a resource: the first that is measured and more than yes or no. */
function keyOf(resource: string | null, variables: Variables): string | null {
	let yesOrNo: string | null = null;
	for (const [name, variable] of Object.entries(variables)) {
		if (resource === null || variable.resource !== resource || variable.kind !== 'measured') continue;
		if (typeof variable.domain[0] !== 'boolean') return name;
		yesOrNo ??= name;
	}
	return yesOrNo;
}

/** The values in brackets behind the names of what runs: what is being worked on, by a person or by a device. */
export function inWork(view: StationView): ReadonlyMap<string, 'person' | 'device'> {
	const found = new Map<string, 'person' | 'device'>();
	for (const [name, ability] of Object.entries(view.abilities))
		if (ability.executing === true || ability.running_since !== null)
			for (const value of /\(([^()]*)\)$/.exec(name)?.[1]?.split(', ') ?? [])
				found.set(value, ability.human ? 'person' : 'device');
	return found;
}

/** The last index of a variable: `bolt_pair_1` of `bolts[bolt_pair_1]`. */
export function indexOf(variable: string): string | null {
	return /\[(?:[^[\]]*, )?([^[\],]*)\]$/.exec(variable)?.[1] ?? null;
}
