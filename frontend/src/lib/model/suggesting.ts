/** What can be written in a field that takes a name of the model. */
import { entriesOf, isList, textAt, valueAt, type Json } from './content.ts';
import type { Spot } from './language.ts';
import { messageOf, resourceOf, STATION } from './tree.ts';
import { layersOf, typeOf } from './types.ts';

type Contents = Readonly<Record<string, Json | undefined>>;

const namesAt = (content: Json | undefined, key: string): string[] => entriesOf(valueAt(content, [key])).map(([name]) => name);

const textsIn = (value: Json | undefined): string[] => (isList(value) ? value.filter((each) => typeof each === 'string') : []);

/** The values that a variable of that type can have; none where they are not names. `around` includes it already. */
function valuesOf(contents: Contents, type: string | null, around: readonly string[] = []): string[] {
	if (type === 'bool') return ['true', 'false'];
	if (type === null || around.includes(type)) return [];
	const set = valueAt(contents[STATION], ['sets', type]);
	if (set !== undefined) return membersOf(contents, set, [...around, type]);
	const written = valueAt(contents[STATION], ['enumerations', type]);
	const own = isList(written) ? written : valueAt(written, ['values']);
	const included = valueAt(written, ['includes']);
	return [...textsIn(own), ...textsIn(included).flatMap((each) => valuesOf(contents, each, [...around, type]))];
}

/** The values in a set as it is written. */
function membersOf(contents: Contents, set: Json, around: readonly string[]): string[] {
	const whole = valuesOf(contents, textAt(set, ['of']), around);
	const values = valueAt(set, ['values']);
	const named = textsIn(values ?? valueAt(set, ['except'])).flatMap((each) =>
		whole.includes(each) ? [each] : valuesOf(contents, each, around)
	);
	return values === undefined ? whole.filter((each) => !named.includes(each)) : named;
}

/** The sets with nothing in them but these values. */
function setsWithin(contents: Contents, values: readonly string[]): string[] {
	return namesAt(contents[STATION], 'sets')
		.filter((each) => valuesOf(contents, each).every((value) => values.includes(value)))
		.toSorted();
}

/** The names that each have a value in the table at a place, and what is so for all others; null where it is no such table. */
export function keysFor({ file, path }: Spot, contents: Contents): { names: string[]; otherwise: string } | null {
	if (path.length === 1 && path[0] === 'arguments') {
		const [type] = layersOf(file, contents);
		return type ? { names: namesAt(type.content, 'parameters'), otherwise: '' } : null;
	}
	if (file !== STATION || path[0] !== 'maps' || path.at(-1) !== 'values') return null;
	const map = valueAt(contents[STATION], path.slice(0, -1));
	return { names: valuesOf(contents, textAt(map, ['from'])), otherwise: String(valueAt(map, ['otherwise']) ?? '') };
}

/** The sets that stand for several names of that table. */
export function groupsFor(spot: Spot, contents: Contents): string[] {
	return spot.file === STATION ? setsWithin(contents, keysFor(spot, contents)?.names ?? []) : [];
}

/** What could be written in a set, a relation, a map or an enumeration of the station; null for all else. */
function inShorthand(name: string, path: Spot['path'], contents: Contents): string[] | null {
	const station = contents[STATION];
	const [section, called] = path.map(String);
	if (called === undefined) return null;
	const domains = [...namesAt(station, 'enumerations'), ...namesAt(station, 'sets')].filter((each) => each !== called).toSorted();
	const at = (key: string): Json | undefined => valueAt(station, [String(section), called, key]);
	const text = (key: string): string | null => textAt(station, [String(section), called, key]);
	const members = (domain: string | null): string[] => {
		const values = valuesOf(contents, domain);
		return [...values, ...setsWithin(contents, values).filter((each) => each !== called && each !== domain)];
	};
	switch (`${section ?? ''}.${name}`) {
		case 'enumerations.includes':
			return namesAt(station, 'enumerations').filter((each) => each !== called).toSorted();
		case 'sets.of':
		case 'relations.between':
		case 'maps.from':
			return domains;
		case 'maps.to':
			return ['bool', ...domains];
		case 'sets.values':
		case 'sets.except':
			return members(text('of'));
		case 'relations.pairs':
			return [...new Set(textsIn(at('between')).flatMap(members))];
		case 'maps.values':
		case 'maps.otherwise':
			return valuesOf(contents, text('to'));
		default:
			return null;
	}
}

/** What could be written in the field `name` at a place, in alphabetical order but for the values of a type. */
export function suggestionsFor(name: string, { file, path }: Spot, contents: Contents, files: readonly string[]): string[] {
	const resource = contents[file];
	const enumerations = ['enumerations', 'sets'].flatMap((key) => namesAt(contents[STATION], key));
	if (file !== STATION) enumerations.push(...namesAt(resource, 'sets'));
	const section = path[0];
	const inShort = file === STATION ? inShorthand(name, path, contents) : null;
	if (inShort !== null) return inShort;
	switch (name) {
		case 'arguments':
			return [...enumerations, ...Object.keys(contents).flatMap((each) => resourceOf(each) ?? [])].toSorted();
		case 'remove':
			return [];
		case 'type': {
			if (path.length === 1) return files.flatMap((each) => typeOf(each) ?? []).toSorted();
			const kind = { topics: 'msg', services: 'srv', actions: 'action' }[String(section)];
			if (kind === undefined) return ['bool', ...enumerations.toSorted()];
			return files.flatMap((each) => messageOf(each) ?? []).filter((each) => each.split('/')[1] === kind).toSorted();
		}
		case 'initial':
			return valuesOf(contents, textAt(resource, [...path.slice(0, -1), 'type']));
		case 'parameters':
		case 'for':
			return enumerations.toSorted();
		case 'acknowledgement':
		case 'status':
			return namesAt(resource, 'measured').toSorted();
		case 'zone':
			return Object.keys(contents).flatMap((each) => resourceOf(each) ?? []).toSorted();
		case 'exclusive':
			return Object.entries(contents)
				.flatMap(([each, content]) => {
					const owner = resourceOf(each);
					return owner === null ? [] : namesAt(content, 'abilities').map((ability) => `${owner}.${ability}`);
				})
				.toSorted();
		case 'when':
			return section === 'services' || section === 'actions' ? namesAt(resource, 'output').toSorted() : [];
		default:
			return [];
	}
}
