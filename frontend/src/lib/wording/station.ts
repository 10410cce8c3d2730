/** How the state of execution is said, in the language of the page. */
import type { Mode, PackML, Plan, StationView } from '#lib/contract.ts';
import { header } from '#lib/text/en/header.ts';
import { operate } from '#lib/text/en/operate.ts';
import { say } from '#lib/text/text.svelte.ts';

/** A record whose texts are looked up as they are read, so that they follow the language. */
function spoken<Key extends string>(keys: Readonly<Record<Key, string>>, now: () => Record<Key, string>): Record<Key, string> {
	const made = {} as Record<Key, string>;
	for (const key of Object.keys(keys) as Key[]) Object.defineProperty(made, key, { enumerable: true, get: () => now()[key] });
	return made;
}

export const MODES: Readonly<Record<Mode, string>> = spoken(header.mode, () => say().header.mode);

/** What happens next, and what does not. */
export function modeMeaning({ mode, production }: Pick<StationView, 'mode' | 'production'>): string {
	const { meaning, nothingSent } = say().header;
	if (production === 'started') return meaning[mode];
	return mode === 'automatic' ? nothingSent : `${meaning[mode]} ${nothingSent}`;
}

/** The states of PackML by the names that the standard has for them. */
export const PACKML: Readonly<Record<PackML, string>> = spoken(header.packml, () => say().header.packml);

export const PRODUCTION: Readonly<Record<StationView['production'], string>> = spoken(
	header.production,
	() => say().header.production
);

export const PLAN_STATUS: Readonly<Record<Plan['status'], string>> = spoken(
	operate.plan.statusText,
	() => say().operate.plan.statusText
);

/** `3 starts`, `1 start`; in English. */
export function count(n: number, one: string, many = `${one}s`): string {
	return `${n} ${n === 1 ? one : many}`;
}

/** Milliseconds the planner took: `0.4 ms`, `12 ms`, `1.2 s`. */
export function plannerTime(milliseconds: number): string {
	const { ms, s } = say().common.time;
	if (milliseconds < 10) return ms(Number(milliseconds.toFixed(1)));
	if (milliseconds < 1000) return ms(Math.round(milliseconds));
	return s((milliseconds / 1000).toFixed(1));
}
