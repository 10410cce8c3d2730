/** The graph of pipelines as it is drawn: boxes and the wires between them, each with a name that stays. */

export type BoxKind = 'topic' | 'flow' | 'service' | 'action' | 'variables' | 'stage' | 'variable';

/** Where a record stands on its way: before the stage of that number, or at the end behind the last. */
export interface Spot {
	readonly pipeline: string;
	readonly edge: number;
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

export interface Point {
	readonly x: number;
	readonly y: number;
}

/** Where everything is. */
export interface Layout {
	readonly places: ReadonlyMap<string, Point>;
	/** The corners of each wire, from its source to its target. */
	readonly ways: ReadonlyMap<string, readonly Point[]>;
}
