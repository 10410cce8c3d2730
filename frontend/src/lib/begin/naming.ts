/** Names that follow from titles, until somebody writes one. */
import type { Called } from './sketch.ts';

/** What is called `title` as a name of the model: `Robot 2, left` is `robot_2_left`; empty where no letter is left. */
export function nameOf(title: string): string {
	const name = title
		.toLowerCase()
		.replaceAll(/æ/g, 'ae')
		.replaceAll(/ø/g, 'o')
		.replaceAll(/ß/g, 'ss')
		.normalize('NFKD')
		.replaceAll(/\p{M}/gu, '')
		.replaceAll(/[^a-z0-9]+/g, '_')
		.replaceAll(/^_+|_+$/g, '')
		.slice(0, 60)
		.replace(/_+$/, '');
	return /^\d/.test(name) ? `_${name}` : name;
}

/** `name`, or with a number where that is taken. */
export function freeName(name: string, taken: Iterable<string>): string {
	const others = new Set(taken);
	if (name === '' || !others.has(name)) return name;
	for (let n = 2; ; n++) if (!others.has(`${name}_${n}`)) return `${name}_${n}`;
}

/** Gives a part another title, and the name that follows from it unless it has one of its own. */
export function retitle(part: Called, title: string, taken: readonly string[]): void {
	const follows = part.name === '' || part.name === freeName(nameOf(part.title), taken);
	part.title = title;
	if (follows) part.name = freeName(nameOf(title), taken);
}

/** The names of all but one. */
export function others(parts: readonly Called[], part: Called): string[] {
	return parts.filter(({ id }) => id !== part.id).map(({ name }) => name);
}
