/** The picture of an instruction with the state of the station in it. */
import type { StationView } from '#lib/contract.ts';

type Variables = Readonly<Record<string, Pick<StationView['variables'][string], 'value'>>>;

/**
 * The address at which a drawing shows the values of indexed variables, which is another one whenever one of these is another; other
 * pictures, and drawings without variables, stay as they are.
 */
export function drawnAt(image: string, variables: Variables | undefined): string {
	const [file = '', part = ''] = image.split('#');
	if (variables === undefined || !file.endsWith('.svg')) return image;
	const values = Object.entries(variables).filter(([name]) => name.endsWith(']')).map(([name, { value }]) => `${name}=${String(value)}`);
	return values.length === 0 ? image : `${file}?state=${hash(values.join())}${part === '' ? '' : `#${part}`}`;
}

/** A few letters, which are others for another text (FNV-1a). */
function hash(text: string): string {
	let found = 0x811c9dc5;
	for (const letter of text) found = Math.imul(found ^ (letter.codePointAt(0) ?? 0), 0x01000193) >>> 0;
	return found.toString(36);
}
