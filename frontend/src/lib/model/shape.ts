/** What the parts of a model's documents look like: their fields, and of what kind each is. */

/**
 * How a field is written. `part` is one part below its name, `parts` are any number, each below a name of its own. Behind
 * the names of `named` is a scalar each, of `numbers` and `words` a list, of `bounds` what a person may set; `rows` are
 * those of a table, and `couples` those of a relation: a name, or several, on each side. `parameters` are those of a type of
 * resources, each of one of the kinds that can be chosen.
 */
export type FieldKind =
	| 'text'
	| 'number'
	| 'flag'
	| 'choice'
	| 'interval'
	| 'value'
	| 'scalar'
	| 'scalars'
	| 'named'
	| 'numbers'
	| 'words'
	| 'bounds'
	| 'rows'
	| 'couples'
	| 'names'
	| 'texts'
	| 'lists'
	| 'predicate'
	| 'predicates'
	| 'zone'
	| 'part'
	| 'parts'
	| 'parameters'
	| 'yaml';

export interface FieldShape {
	readonly kind: FieldKind;
	/** What it is for, as the documents say. */
	readonly help: string;
	readonly required: boolean;
	/** The part that is below it. */
	readonly part?: string;
	readonly choices?: readonly (string | number)[];
	/** What counts where it is left out. */
	readonly otherwise?: string | number | boolean;
	/** Its names are fields of messages, or texts, which have more signs than names of a model. */
	readonly loose?: boolean;
	/** It has exactly so many entries. */
	readonly count?: number;
	/** What a number counts: seconds. */
	readonly unit?: 's';
	/** Only whole numbers. */
	readonly whole?: boolean;
	readonly least?: number;
	/** It is more than this. */
	readonly above?: number;
	readonly most?: number;
}

export interface PartShape {
	readonly about: string;
	readonly fields: Readonly<Record<string, FieldShape>>;
}
