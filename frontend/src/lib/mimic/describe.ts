/** What is said of a thing in the picture, in words. */
import type { Mimic, MimicPart, MimicSymbol, MimicTrack, StationView } from '#lib/contract.ts';
import type { Doing } from '#lib/resource/doing.ts';
import { nextSteps, STUCK } from '#lib/plan/status.ts';
import { runs } from '#lib/resource/running.ts';
import { told } from '#lib/text/message.ts';
import { awaitsOrder } from '#lib/task/standing.ts';
import { inLanguage, say } from '#lib/text/text.svelte.ts';
import { capital } from '#lib/wording/capital.ts';
import { listed } from '#lib/wording/listed.ts';
import { inSentence } from '#lib/wording/names.svelte.ts';
import { nameOf as nameOfVariable } from '#lib/wording/names.svelte.ts';
import { plain, valueText } from '#lib/wording/values.ts';
import { alarmsOf, holds, saidOf, sentTo, valueOf, whereabouts, type Variables } from './live.ts';

/** What of the station a picture shows. */
export type Pictured = Pick<StationView, 'abilities' | 'alarms' | 'operations' | 'resources' | 'tasks' | 'variables'>;

export interface Now {
	readonly text: string;
	/** `doubt`: it is not known. */
	readonly tone: 'rests' | 'active' | 'doubt';
}

/** What a thing is called. */
export function nameOf(symbol: MimicSymbol, resources: StationView['resources'], language: string): string {
	const own = inLanguage(symbol.title, language);
	if (own !== '' || symbol.resource === null) return own;
	return resources[symbol.resource]?.title ?? plain(symbol.resource);
}

/** What a stop is called. */
export function stopName(track: MimicTrack, value: string, language: string): string {
	const title = track.stops.find((stop) => stop.value === value)?.title ?? {};
	return inLanguage(title, language) || plain(value);
}

/** The stop that an ability is about, as the picture calls it: where it leads. Null where the picture does not name it. */
export function stopOf({ track }: MimicSymbol, ability: string, language: string): string | null {
	const values = valuesIn(ability);
	const stop = track?.stops.find(({ value }) => values.includes(value));
	return (stop && inLanguage(stop.title, language)) || null;
}

/** What is found of all resources at once. */
export interface Found {
	readonly doing: ReadonlyMap<string, Doing>;
	/** The variable that says most of each. */
	readonly keys: ReadonlyMap<string, string>;
}

/** What a thing does or is. `waits`: it stands where an operation has stopped. */
export function nowOf(symbol: MimicSymbol, view: Pictured, found: Found, language: string, waits = false): Now {
	const texts = say().mimic;
	const { variables, tasks } = view;
	const resource = symbol.resource;
	if (resource !== null && view.resources[resource]?.online === false)
		return { text: lastPlace(symbol.track, variables, texts.notHeard, language), tone: 'doubt' };
	const running = found.doing.get(resource ?? '')?.running ?? [];
	// What it last measured would read as what is wrong with it. Of what moves it is told where it is, of a person their task.
	const isDevice = symbol.track === null && symbol.symbol !== 'person';
	const moves = symbol.active.length > 0 && holds(symbol.active, variables) === true;
	// What a Hold has called off is no longer to go on.
	const isStuck = alarmsOf(view.alarms, resource).some(([, { kind }]) => STUCK.has(kind) && (kind !== 'overdue' || running.length > 0));
	if (isDevice && isStuck) {
		const does = moves ? saidOf(symbol.texts, variables, language) : '';
		return { text: does === '' ? texts.stuck : texts.movesStuck(does), tone: 'rests' };
	}
	const active = running.length > 0 || moves;
	const tone = active ? 'active' : 'rests';
	if (symbol.track !== null) return whereNow(symbol.track, view, active, waits && running.length === 0, language);
	if (symbol.symbol === 'person') {
		const task = Object.values(tasks).find((each) => each.resource === resource);
		if (task !== undefined) return { text: task.title, tone: 'active' };
	}
	const said = saidOf(symbol.texts, variables, language);
	if (active && running[0] !== undefined && (said === '' || symbol.active.length === 0)) return { text: running[0].title, tone };
	if (said !== '') return { text: said, tone };
	// What a device of a person last measured says nothing of the person.
	if (symbol.symbol === 'person' && !active) return { text: texts.free, tone };
	if (symbol.texts.some(({ when }) => holds(when, variables) === null)) return { text: capital(say().common.unknown), tone: 'doubt' };
	const key = found.keys.get(resource ?? '');
	if (key === undefined) return { text: resource === null || symbol.parts.length > 0 ? '' : texts.rests, tone };
	const value = valueOf(variables, key);
	const told = value === null ? say().common.unknown : valueText(value);
	return { text: capital(texts.is(nameOfVariable(key, resource), told)), tone: value === null ? 'doubt' : tone };
}

function whereNow(track: MimicTrack, view: Pictured, active: boolean, waits: boolean, language: string): Now {
	const texts = say().mimic;
	const { variables } = view;
	const at = whereabouts(track, variables, null);
	if (valueOf(variables, track.position) === null) return { text: lastPlace(track, variables, texts.unknownPlace, language), tone: 'doubt' };
	const target = sentTo(track, variables);
	if (at === null || (at.kind === 'moving' && target === null)) return { text: texts.between, tone: 'active' };
	const stop = capital(stopName(track, at.kind === 'moving' ? (target ?? at.to) : at.to, language));
	if (at.kind === 'moving') return { text: texts.towards(stop), tone: 'active' };
	if (waits) return { text: texts.atWork(stop, texts.standsWaiting), tone: 'rests' };
	const work = workAt(at.to, view);
	if (work === null) return { text: stop, tone: active ? 'active' : 'rests' };
	const isNamed = work.toLowerCase().includes(stop.toLowerCase());
	return { text: isNamed ? work : texts.atWork(stop, work), tone: 'active' };
}

/** Say of what moves that nobody knows where it is now, and where it was before. */
function lastPlace(track: MimicTrack | null, variables: Variables, said: string, language: string): string {
	const at = track && whereabouts(track, variables, null);
	return track && at?.kind === 'doubt' ? say().mimic.last(said, stopName(track, at.from, language)) : said;
}

/** What is done at a stop: by a device there, or for the operation that is about it while a device works. */
function workAt(stop: string, { abilities, operations }: Pictured): string | null {
	const working = Object.entries(abilities).filter(([, ability]) => !ability.human && runs(ability));
	const own = working.find(([name]) => valuesIn(name).includes(stop));
	if (own !== undefined) return own[1].title;
	if (working.length === 0) return null;
	return Object.entries(operations).find(([name, { active }]) => active && valuesIn(name).includes(stop))?.[1].title ?? null;
}

/** The variable that says most of each resource: the first that is measured and more than yes or no. */
export function keysOf(variables: Variables): ReadonlyMap<string, string> {
	const [found, yesOrNo] = [new Map<string, string>(), new Map<string, string>()];
	for (const name in variables) {
		const variable = variables[name];
		if (variable?.resource == null || variable.kind !== 'measured') continue;
		const among = typeof variable.domain[0] === 'boolean' ? yesOrNo : found;
		if (!among.has(variable.resource)) among.set(variable.resource, name);
	}
	return new Map([...yesOrNo, ...found]);
}

/** The values in brackets behind the names of what runs: what is being worked on, by a person or by a device. */
export function inWork(view: Pick<Pictured, 'abilities'>): ReadonlyMap<string, 'person' | 'device'> {
	const found = new Map<string, 'person' | 'device'>();
	for (const [name, ability] of Object.entries(view.abilities))
		if (ability.executing === true || ability.running_since !== null)
			for (const value of valuesIn(name)) found.set(value, ability.human ? 'person' : 'device');
	return found;
}

/** The values in brackets behind a name: `pair_1` of `tighten(pair_1)`. */
export function valuesIn(name: string): string[] {
	return /\(([^()]*)\)$/.exec(name)?.[1]?.split(', ') ?? [];
}

/** The last index of a variable: `bolt_pair_1` of `bolts[bolt_pair_1]`. */
export function indexOf(variable: string): string | null {
	return /\[(?:[^[\]]*, )?([^[\],]*)\]$/.exec(variable)?.[1] ?? null;
}

/** What the value of a part is called. */
export function partValue(part: MimicPart, variables: Variables, language: string): string {
	const value = valueOf(variables, part.variable);
	return value === null ? say().common.unknown : (titleIn(part, String(value), language) ?? valueText(value));
}

function titleIn(part: MimicPart, value: string, language: string): string | null {
	const title = part.titles[value];
	return title === undefined ? null : inLanguage(title, language);
}

export type Legend = readonly { readonly look: MimicPart['looks'][string]; readonly text: string }[];
/** More values of one look are not all named. */
const NAMED = 2;

/** What the marks of the product are called: those of the parts of which there are most. */
export function legendOf({ symbols }: Pick<Mimic, 'symbols'>, language: string): Legend {
	const parts = symbols.flatMap((symbol) => symbol.parts);
	const part = parts.find(({ label }) => label !== '') ?? parts[0];
	if (part === undefined) return [];
	const values = Object.entries(part.looks);
	return (['empty', 'placed', 'done'] as const).flatMap((look) => {
		const own = values.filter((each) => each[1] === look).map(([value]) => titleIn(part, value, language) ?? worded(value));
		return own.length === 0 || own.length > NAMED ? [] : [{ look, text: own.join(', ') }];
	});
}

/** The text of a value as it stands among the looks. */
function worded(value: string): string {
	return value === 'true' || value === 'false' ? valueText(value === 'true') : plain(value);
}

/** What happens now and what comes then, in one sentence. */
export function happening(view: StationView): string {
	const texts = say().mimic;
	// What such a device does is not what its ability says.
	const wrong = new Set([...view.silent, ...view.failing]);
	const running = Object.values(view.abilities)
		.filter((ability) => runs(ability) && !wrong.has(view.resources[ability.resource]?.title ?? ''))
		.sort((a, b) => Number(a.human) - Number(b.human))
		.map(({ title }) => title);
	const next = nextSteps(view.plan)[0];
	const now = running.length > NAMED ? texts.andMore(running.slice(0, NAMED).join(' · '), running.length - NAMED) : running.join(' · ');
	// What is begun on a device that is not heard may be so, or not; and so may what comes after it.
	const silent = view.silent.length > 0 ? texts.unheard(listed(view.silent), view.silent.length) : '';
	const failing = view.failing.length > 0 ? texts.failing(listed(view.failing), view.failing.length) : '';
	if (wrong.size > 0) return [now, failing, silent].filter((each) => each !== '').join(' · ');
	if (running.length === 0) {
		// What a condition is called is told, never how it is written.
		const waits = next !== undefined ? told(next.sentence, '') : awaitsOrder(view) ? say().frame.nothingNext.noOrder : '';
		return waits === '' ? texts.nothingMoves : texts.nothingMovesAnd(waits);
	}
	const then = next === undefined ? null : inSentence(next.title);
	return then === null ? now : texts.then(now, then);
}
