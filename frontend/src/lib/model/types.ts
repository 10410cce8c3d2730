/** What instances have of the types of resources that they are of. */
import { entriesOf, isList, isMapping, textAt, valueAt, type Json, type Path } from './content.ts';

type Contents = Readonly<Record<string, Json | undefined>>;

/** The file of a type is called after it, in a folder of its package where it is of one; null where the file is another one. */
export function typeOf(file: string): string | null {
	const [, packaged, name] = /^(?:packages\/(\w+)\/)?types\/(\w+)\.yaml$/.exec(file) ?? [];
	return name === undefined ? null : packaged === undefined ? name : `${packaged}.${name}`;
}

export function typeFile(name: string): string {
	const [first = '', second] = name.split('.');
	return second === undefined ? `types/${first}.yaml` : `packages/${first}/types/${second}.yaml`;
}

/** A type of which something is, with what the parameters of it are as far as they are given. */
export interface Layer {
	readonly type: string;
	readonly file: string;
	readonly content: Json | undefined;
	readonly given: Readonly<Record<string, string>>;
}

/** The types of what a file holds, the nearest first. */
export function layersOf(file: string, contents: Contents): Layer[] {
	const layers: Layer[] = [];
	let from = { file, given: {} as Readonly<Record<string, string>> };
	for (;;) {
		const named = textAt(contents[from.file], ['type']);
		if (named === null) return layers;
		const [, packaged] = /^packages\/(\w+)\//.exec(from.file) ?? [];
		const type = named.includes('.') || packaged === undefined ? named : `${packaged}.${named}`;
		const found = typeFile(type);
		if (layers.some((each) => each.file === found) || contents[found] === undefined) return layers;
		const own = entriesOf(valueAt(contents[from.file], ['arguments']));
		const given = Object.fromEntries(own.map(([name, value]) => [name, from.given[String(value)] ?? String(value)]));
		from = { file: found, given };
		layers.push({ type, file: found, content: contents[found], given });
	}
}

/** A text with what is given in the place of parameters in braces. */
export const filled = (text: string, given: Readonly<Record<string, string>>): string =>
	text.replaceAll(/\{(\w+)\}/g, (all, name: string) => given[name] ?? all);

/** The value at `path` of a type, whose names may have parameters in them. */
function valueIn({ content, given }: Layer, path: Path): Json | undefined {
	let value: Json | undefined = content;
	for (const step of path) {
		if (isMapping(value) && typeof step === 'string') {
			value = entriesOf(value).find(([name]) => filled(name, given) === step)?.[1];
		} else value = valueAt(value, [step]);
	}
	return value;
}

/** What an instance has of a type at `path`, if that is there; the types in `layers` are the nearest first. */
export function inherited(layers: readonly Layer[], path: Path): { readonly type: string; readonly value: Json } | null {
	for (const layer of layers) {
		const value = valueIn(layer, path);
		if (value !== undefined) return { type: layer.type, value };
	}
	return null;
}

/** The names below `path` in the types, in the order of the outermost, without those that something `removed`. */
export function namesIn(layers: readonly Layer[], path: Path, removed: readonly string[]): [name: string, type: string][] {
	const found = new Map<string, string>();
	for (const layer of layers.toReversed())
		for (const [name] of entriesOf(valueIn(layer, path))) found.set(filled(name, layer.given), layer.type);
	return [...found].filter(([name]) => !removed.includes([...path, name].join('.')));
}

/** The entries that the instance has taken away from its type, each by its path. */
export function removedFrom(content: Json | undefined): string[] {
	const list = valueAt(content, ['remove']);
	return isList(list) ? list.filter((each) => typeof each === 'string') : [];
}

/** A value as it is told in a line. */
export function toldValue(value: Json): string {
	if (isList(value)) return value.map(toldValue).join(', ');
	if (isMapping(value)) return Object.entries(value).map(([name, each]) => `${name}: ${toldValue(each)}`).join(', ');
	return String(value);
}
