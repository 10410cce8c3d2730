/** Where operations lie: a lane for each resource, and further to the right what comes later. */
import type { DraftOperation, OperationLink } from '#lib/contract.ts';

export interface Spot {
	readonly lane: string;
	/** How many others come before it, at most, or could. */
	readonly column: number;
	/** Of several in one lane and column. */
	readonly row: number;
}

export interface Lane {
	/** The name of the resource; empty for the station. */
	readonly name: string;
	/** Rows above it, and of its own. */
	readonly top: number;
	readonly rows: number;
}

export interface Sheet {
	readonly spots: ReadonlyMap<string, Spot>;
	readonly lanes: readonly Lane[];
	readonly columns: number;
}

type Operations = Readonly<Record<string, Pick<DraftOperation, 'lane'>>>;
type Links = readonly OperationLink[];

/** The place of each operation. Lanes are in the order in which they are first needed. */
export function sheetOf(operations: Operations, links: Links): Sheet {
	const columns = columnsOf(Object.keys(operations), links);
	const used = [...new Set(columns.values())].sort((a, b) => a - b);
	const places = Object.entries(operations).map(([name, { lane }]) => ({
		name,
		lane: lane ?? '',
		column: used.indexOf(columns.get(name) ?? 0)
	}));
	const lanes: Lane[] = [];
	const spots = new Map<string, Spot>();
	let top = 0;
	const first = (lane: string): number => Math.min(...places.filter((each) => each.lane === lane).map(({ column }) => column));
	for (const lane of [...new Set(places.map((each) => each.lane))].sort((a, b) => first(a) - first(b))) {
		const filled = new Map<number, number>();
		for (const { name, column } of places.filter((each) => each.lane === lane)) {
			const row = filled.get(column) ?? 0;
			filled.set(column, row + 1);
			spots.set(name, { lane, column, row });
		}
		const rows = Math.max(...filled.values());
		lanes.push({ name: lane, top, rows });
		top += rows;
	}
	return { spots, lanes, columns: used.length };
}

/** Behind all that surely comes before it, and behind one of those of which any will do; but not before it is needed. */
function columnsOf(names: readonly string[], links: Links): Map<string, number> {
	const ahead = links.filter(({ again }) => !again);
	const wanted = Map.groupBy(ahead, ({ after }) => after);
	const columns = new Map<string, number>();
	const order: string[] = [];
	/** The links that something must be in sight of: of those of which any will do the first. */
	const needed: OperationLink[] = [];
	const visit = (name: string): number => {
		const known = columns.get(name);
		if (known !== undefined) return known;
		columns.set(name, 0);
		const before = wanted.get(name) ?? [];
		for (const link of before) visit(link.before);
		const first = foremost(before.filter(isChance), columns);
		const behind = [...before.filter((link) => !isChance(link)), ...(first ? [first] : [])];
		needed.push(...behind);
		const column = Math.max(0, ...behind.map((link) => (columns.get(link.before) ?? 0) + 1));
		columns.set(name, column);
		order.push(name);
		return column;
	};
	for (const name of names) visit(name);
	// What could be done earlier stands beside what it is done for.
	for (const name of order.reverse()) {
		const next = needed.filter(({ before }) => before === name).map(({ after }) => columns.get(after) ?? 0);
		if (next.length > 0) columns.set(name, Math.max(columns.get(name) ?? 0, Math.min(...next) - 1));
	}
	return columns;
}

function foremost(links: Links, columns: ReadonlyMap<string, number>): OperationLink | undefined {
	const at = ({ before }: OperationLink): number => columns.get(before) ?? 0;
	return links.reduce<OperationLink | undefined>((first, link) => (first && at(first) <= at(link) ? first : link), undefined);
}

/** The links that are drawn: of those of which any will do the first alone, and those of what is `chosen`. */
export function drawnOf(links: Links, { spots }: Sheet, chosen: string | null): readonly OperationLink[] {
	const columns = new Map([...spots].map(([name, { column }]) => [name, column]));
	const first = new Set([...Map.groupBy(links.filter(isChance), ({ after }) => after).values()].map((each) => foremost(each, columns)));
	return links.filter((link) => !isChance(link) || first.has(link) || link.before === chosen || link.after === chosen);
}

/** Whether one of several will do, of which this is one. */
export function isChance({ reasons }: OperationLink): boolean {
	return reasons.every(({ kind }) => kind === 'chance');
}

/** Whether `name` surely comes before `other`. */
export function isBefore(name: string, other: string, links: Links): boolean {
	const seen = new Set<string>();
	const pending = [name];
	for (let each = pending.pop(); each !== undefined; each = pending.pop()) {
		if (each === other) return true;
		if (seen.has(each)) continue;
		seen.add(each);
		for (const link of links) if (link.before === each && !link.again && !isChance(link)) pending.push(link.after);
	}
	return false;
}
