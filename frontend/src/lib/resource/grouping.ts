/**
 * Which variables stand with which resource, and which of them are its key values. It follows from the model alone, so
 * that it is worked out once and not with every change of a value.
 */
import type { StationView } from '#lib/contract.ts';
import { inRows, type Named } from './pairs.ts';

type Variables = StationView['variables'];

/** Rows of a resource that are shown; where there are hardly more, all are. */
export const KEY_ROWS = 6;
const HARDLY_MORE = 10;

/** A row: a variable, and the command that it answers. */
export interface Place {
	readonly name: string;
	readonly command: string | null;
}

export interface Group {
	/** In the order of the model. */
	readonly key: readonly Place[];
	/** How many variables there are. */
	readonly size: number;
	/** All of them are estimates. */
	readonly estimated: boolean;
}

/** The groups by resource; those of null belong to the station as a whole. */
export type Groups = ReadonlyMap<string | null, Group>;

/** What a resource answers its commands with comes first, then what else it is commanded, measured and believed to be. */
const KEENNESS = { output: 1, measured: 2, estimated: 3 };

export function groupsOf(variables: Variables): Groups {
	const byResource = new Map<string | null, Named[]>();
	for (const [name, variable] of Object.entries(variables)) {
		const group = byResource.get(variable.resource);
		if (group === undefined) byResource.set(variable.resource, [[name, variable]]);
		else group.push([name, variable]);
	}
	return new Map([...byResource].map(([resource, named]) => [resource, groupOf(named)]));
}

function groupOf(named: readonly Named[]): Group {
	const rows = inRows(named);
	const rank = ({ variable, command }: (typeof rows)[number]): number => (command ? 0 : KEENNESS[variable.kind]);
	const first = rows.length <= HARDLY_MORE ? rows : rows.toSorted((a, b) => rank(a) - rank(b)).slice(0, KEY_ROWS);
	const shown = new Set(first);
	return {
		key: rows
			.filter((row) => shown.has(row))
			.map(({ name, command }) => ({ name, command: command === null ? null : command[0] })),
		size: named.length,
		estimated: named.every(([, variable]) => variable.kind === 'estimated')
	};
}

/** Works the groups out anew only where there are other variables than before. */
export class Grouping {
	#names: readonly string[] = [];
	#groups: Groups = new Map();

	of(variables: Variables): Groups {
		const names = Object.keys(variables);
		const same = names.length === this.#names.length && names.every((name, index) => name === this.#names[index]);
		if (!same) {
			this.#groups = groupsOf(variables);
			this.#names = names;
		}
		return this.#groups;
	}
}
