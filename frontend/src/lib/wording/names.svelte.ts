/**
 * What variables, their values and the other parts are called, as the model says, in the language of the page.
 *
 * It is asked for once, and again with another model; until it is there, names are said in words.
 */
import type { Names, StationView, Value } from '#lib/contract.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';
import { language, say } from '#lib/text/text.svelte.ts';
import { capital } from './capital.ts';
import { tellTitles } from './titled.svelte.ts';
import { valueText, variableName } from './values.ts';

/** Milliseconds after which what was refused is asked for again. */
const AGAIN = 2000;

const reading = new Reading<Names>('/api/v1/names');

/** Asks for the names; the result ends that. */
export function readNames(): () => void {
	const ask = (): Promise<void> => reading.again().then(() => tellTitles(reading.value));
	void ask();
	const timer = setInterval(() => reading.refusal && void ask(), AGAIN);
	return () => clearInterval(timer);
}

/** What a variable is called below the title of its resource: `Target of the robot`; in words: `Target pose`. */
export function nameOf(name: string, resource: string | null): string {
	const called = reading.value?.variables[name]?.title;
	const title = called?.[language()] ?? called?.['en'];
	if (title !== undefined) return title;
	return capital(variableName(name, resource));
}

/** The same where its resource is not in sight. A name that another variable has too is told with its resource. */
export function fullName(view: Pick<StationView, 'resources' | 'variables'> | null, name: string): string {
	const resource = view?.variables[name]?.resource ?? null;
	const own = nameOf(name, resource);
	if (resource === null || (reading.value !== null && namesakes()[own] === 1)) return own;
	return `${view?.resources[resource]?.title ?? resource} · ${own}`;
}

/** A name as it stands within a sentence: `bolt pair 4`, and `AGV` as it is. */
export function inSentence(name: string): string {
	return /^\p{Lu}\p{Ll}/u.test(name) ? name.slice(0, 1).toLocaleLowerCase() + name.slice(1) : name;
}

let counted: { readonly names: Names | null; readonly language: string; readonly by: Readonly<Record<string, number>> } | null = null;

/** How many variables have each name. */
function namesakes(): Readonly<Record<string, number>> {
	const [names, spoken] = [reading.value, language()];
	if (counted?.names !== names || counted.language !== spoken) {
		const by: Record<string, number> = {};
		for (const name of Object.keys(names?.variables ?? {})) {
			const own = nameOf(name, null);
			by[own] = (by[own] ?? 0) + 1;
		}
		counted = { names, language: spoken, by };
	}
	return counted.by;
}

/** What a value of a variable is called, or that it is not known. */
export function valueOf(name: string, value: Value | null): string {
	if (value === null) return say().common.unknown;
	const place = reading.value?.variables[name]?.values ?? null;
	const words = place === null ? undefined : reading.value?.values[place]?.[String(value)];
	return words?.[language()] ?? words?.['en'] ?? valueText(value);
}

/** The topic that tells what a measured variable is. */
export function topicOf(name: string): string | null {
	return reading.value?.variables[name]?.topic ?? null;
}
