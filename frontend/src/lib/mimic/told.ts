/** All that the picture tells of its things, once for the drawing, the rows and the table. */
import type { Mimic, MimicSymbol, Priority } from '#lib/contract.ts';
import type { Stopped } from '#lib/operation/standing.ts';
import { doingOf } from '#lib/resource/doing.ts';
import { inLanguage, say } from '#lib/text/text.svelte.ts';
import { nameOf as nameOfVariable } from '#lib/wording/names.svelte.ts';
import { isOutside, isPartAffected, standsAffected } from './affected.ts';
import { keysOf, nameOf, nowOf, partValue, type Now, type Pictured } from './describe.ts';
import { placeOf, type Point } from './geometry.ts';
import { alarmsOf, holds, levelOf, valueOf, whereabouts, worst } from './live.ts';

export interface Told {
	readonly symbol: MimicSymbol;
	readonly title: string;
	readonly now: Now;
	/** What it does or is, with its parts and what it holds: for who does not see it. */
	readonly sentence: string;
	readonly alarm: Priority | null;
	/** It lights up as this: by its alarm, as it stands where an operation has stopped, or as it is what it must not be. */
	readonly lit: Priority | null;
	/** Where it stands on its track; null where it has none, or nobody knows. */
	readonly stands: Point | null;
	/** The variables of its parts that light up, and as what. */
	readonly parts: ReadonlyMap<string, Priority>;
}

/** `stopped` are the operations that came to a stop, if any did; `outside` the variables that are what they must not be. */
export function toldOf(mimic: Mimic, view: Pictured, language: string, stopped: Stopped | null = null, outside: ReadonlySet<string> = new Set()): Told[] {
	const found = { doing: doingOf(view.abilities), keys: keysOf(view.variables) };
	return mimic.symbols.map((symbol) => {
		const alarm = worst(alarmsOf(view.alarms, symbol.resource));
		const stands = stopped !== null && standsAffected(symbol, view, stopped);
		const now = nowOf(symbol, view, found, language, stands);
		const parts = symbol.parts.flatMap((part): [string, Priority][] => {
			if (outside.has(part.variable)) return [[part.variable, 'high']];
			return stopped !== null && isPartAffected(part, view, stopped) ? [[part.variable, stopped.priority]] : [];
		});
		return {
			symbol,
			title: nameOf(symbol, view.resources, language),
			now,
			sentence: [now.text, ...details(symbol, view, language)].filter((text) => text !== '').join('. '),
			alarm,
			stands: standsAt(symbol, view),
			lit: isOutside(symbol, view, outside) ? 'high' : (alarm ?? (stands ? stopped.priority : null)),
			parts: new Map(parts)
		};
	});
}

function standsAt({ track }: MimicSymbol, { variables }: Pictured): Point | null {
	const at = track && whereabouts(track, variables, null);
	return at && placeOf(track, at);
}

function details(symbol: MimicSymbol, view: Pictured, language: string): string[] {
	const texts = say().mimic;
	const { variables } = view;
	const level = levelOf(symbol, variables);
	const found = symbol.slots.map((slot) => {
		const there = holds(slot.holds, variables);
		const thing = inLanguage(slot.title, language);
		return there === null ? texts.unknownThing(thing) : there ? texts.isThere(thing) : texts.isGone(thing);
	});
	if (symbol.level !== null && level !== null)
		found.push(
			texts.is(
				nameOfVariable(symbol.level.variable, symbol.resource),
				texts.of(Number(valueOf(variables, symbol.level.variable)), symbol.level.highest)
			)
		);
	for (const part of symbol.parts) {
		const name = inLanguage(part.title, language) || nameOfVariable(part.variable, null);
		found.push(texts.is(name, partValue(part, variables, language)));
	}
	return found;
}
