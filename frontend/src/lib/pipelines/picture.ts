/** The graph of pipelines as it is drawn: boxes and the wires between them, each with a name that stays. */

export type BoxKind = 'topic' | 'flow' | 'service' | 'action' | 'variables' | 'stage' | 'variable';

/** Where a record stands on its way: before the stage of that number, or at the end behind the last. */
export interface Spot {
	readonly pipeline: string;
	readonly edge: number;
}

/** A field that a box shows, with what it is in the record that it stands for. */
export interface Row {
	readonly field: string;
	readonly label: string;
}

export interface Box {
	/** The same for as long as the same thing is drawn. */
	readonly id: string;
	readonly kind: BoxKind;
	/** The pipeline that it belongs to. */
	readonly pipeline: string;
	/** The place of a stage in it, from 0. */
	readonly stage: number | null;
	readonly name: string;
	/** What it does, or is, in short. */
	readonly about: string;
	readonly troubles: readonly string[];
	/** The type of a variable. */
	readonly type: string | null;
	/** The first fields of its record; none of a variable, which has a value. */
	readonly rows: readonly Row[];
	/** How many fields of its record are not among them. */
	readonly more: number;
	/** Where its record passes; null where it has none. */
	readonly spot: Spot | null;
}

export interface Wire {
	readonly id: string;
	readonly from: string;
	readonly to: string;
	/** What passes there; null for one that only says what belongs to what. */
	readonly spot: Spot | null;
	/** The only field that matters on it; null for a whole record. */
	readonly field: string | null;
	/** The types of the fields. */
	readonly fields: Readonly<Record<string, string>>;
	readonly troubles: readonly string[];
}

export interface Picture {
	readonly boxes: readonly Box[];
	readonly wires: readonly Wire[];
}

/** A part of the picture that is laid out for itself, above or below the others. */
export interface Lane extends Picture {
	readonly id: string;
	/** What stands above it; empty for nothing. */
	readonly title: string;
	/** The pipelines that begin or end at a device there. */
	readonly pipelines: readonly string[];
}
