/** What can be written in a field that takes a name of the model. */
import { entriesOf, isList, textAt, valueAt, type Json } from './content.ts';
import type { Spot } from './language.ts';
import { messageOf, resourceOf, STATION } from './tree.ts';

type Contents = Readonly<Record<string, Json | undefined>>;

const namesAt = (content: Json | undefined, key: string): string[] => entriesOf(valueAt(content, [key])).map(([name]) => name);

/** The values that a variable of that type can have; none where they are not names. `around` includes it already. */
function valuesOf(contents: Contents, type: string | null, around: readonly string[] = []): string[] {
	if (type === 'bool') return ['true', 'false'];
	if (type === null || around.includes(type)) return [];
	const written = valueAt(contents[STATION], ['enumerations', type]);
	const own = isList(written) ? written : valueAt(written, ['values']);
	const included = valueAt(written, ['includes']);
	const names = (value: Json | undefined): string[] => (isList(value) ? value.filter((each) => typeof each === 'string') : []);
	return [...names(own), ...names(included).flatMap((each) => valuesOf(contents, each, [...around, type]))];
}

/** What could be written in the field `name` at a place, in alphabetical order but for the values of a type. */
export function suggestionsFor(name: string, { file, path }: Spot, contents: Contents, files: readonly string[]): string[] {
	const enumerations = ['enumerations', 'sets'].flatMap((key) => namesAt(contents[STATION], key));
	const resource = contents[file];
	const section = path[0];
	switch (name) {
		case 'type': {
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
