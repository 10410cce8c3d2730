/** All that the picture tells of its things, once for the drawing, the rows and the table. */
import type { Mimic, MimicSymbol, Priority } from '#lib/contract.ts';
import { doingOf } from '#lib/resource/doing.ts';
import { inLanguage, say } from '#lib/text/text.svelte.ts';
import { nameOf as nameOfVariable } from '#lib/wording/names.svelte.ts';
import { keysOf, nameOf, nowOf, partValue, type Now, type Pictured } from './describe.ts';
import { alarmsOf, holds, levelOf, valueOf, worst } from './live.ts';

export interface Told {
	readonly symbol: MimicSymbol;
	readonly title: string;
	readonly now: Now;
	/** What it does or is, with its parts and what it holds: for who does not see it. */
	readonly sentence: string;
	readonly alarm: Priority | null;
}

export function toldOf(mimic: Mimic, view: Pictured, language: string): Told[] {
	const found = { doing: doingOf(view.abilities), keys: keysOf(view.variables) };
	return mimic.symbols.map((symbol) => {
		const now = nowOf(symbol, view, found, language);
		return {
			symbol,
			title: nameOf(symbol, view.resources, language),
			now,
			sentence: [now.text, ...details(symbol, view, language)].filter((text) => text !== '').join('. '),
			alarm: worst(alarmsOf(view.alarms, symbol.resource))
		};
	});
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
