/** Where parts that are dragged in the tree would come to stand. */
import { isBeside, isOrdered, type Target } from './together.ts';
import type { Node, Row } from './tree.ts';

/** A place between two rows, at an edge of one of them. */
export interface Drop extends Target {
	/** The id of the row at which the line is drawn. */
	readonly line: string;
	readonly edge: 'top' | 'bottom';
}

/** The row behind all that is shown in the one at `place`. */
function endOf(rows: readonly Row[], place: number): number {
	const level = rows[place]?.level ?? 0;
	const behind = rows.findIndex((row, each) => each > place && row.level <= level);
	return behind < 0 ? rows.length : behind;
}

/**
 * Where `nodes` would be put that are held over the row at `place`, its upper half or its lower one; null where they cannot be,
 * or stand already. What is shown in a sibling counts as that sibling, the heading as the place before the first.
 */
export function dropAt(rows: readonly Row[], nodes: readonly Node[], place: number, isUpper: boolean): Drop | null {
	const [first] = nodes;
	if (!first) return null;
	const isSibling = (each: Row | undefined): boolean => each !== undefined && isOrdered(each.node) && isBeside(each.node, first);
	const isMoving = ({ id }: Node): boolean => nodes.some((each) => each.id === id);
	let at = place;
	while (at >= 0 && !isSibling(rows[at])) {
		const level = rows[at]?.level ?? 0;
		const up = rows.slice(0, at).findLastIndex((row) => row.level < level);
		// Of the heading itself the place before its first is meant.
		if (at === place && isSibling(rows[place + 1]) && (rows[place + 1]?.level ?? 0) > level) {
			at = place + 1;
			break;
		}
		at = up;
	}
	const row = rows[at];
	if (!row || isMoving(row.node)) return null;
	const where = at > place || (at === place && isUpper) ? 'before' : 'after';
	const order = rows.filter(isSibling).map(({ node }) => node);
	const rest = order.filter((each) => !isMoving(each));
	const to = rest.indexOf(row.node) + (where === 'before' ? 0 : 1);
	const moving = order.filter(isMoving);
	if (rest.toSpliced(to, 0, ...moving).every((each, index) => each === order[index])) return null;
	const line = where === 'before' ? at : endOf(rows, at) - 1;
	return { node: row.node, where, line: rows[line]?.node.id ?? row.node.id, edge: where === 'before' ? 'top' : 'bottom' };
}
