/** Operations that a sequence puts beside one another, as they are drawn: with a frame around them, or with a mark at each. */
import type { DraftOperations } from '#lib/contract.ts';

export type Group = DraftOperations['groups'][number];

export interface Rect {
	readonly x: number;
	readonly y: number;
	readonly width: number;
	readonly height: number;
}

export interface Frame extends Rect {
	readonly kind: Group['kind'];
	/** How many frames lie in it, one within the other. */
	readonly depth: number;
}

export interface Drawn {
	readonly frames: readonly Frame[];
	/** By operation, the groups that no frame shows. */
	readonly marks: ReadonlyMap<string, readonly Group['kind'][]>;
}

/** A frame is drawn where no other operation lies in it, and where it lies in another one, or beside it, as a whole. */
export function drawnGroups(groups: readonly Group[], boxes: ReadonlyMap<string, Rect>): Drawn {
	const frames: (Frame & { readonly members: ReadonlySet<string> })[] = [];
	const marks = new Map<string, Group['kind'][]>();
	const different = new Map(groups.map((group) => [`${group.kind} ${[...group.operations].sort().join(' ')}`, group]));
	for (const { kind, operations } of [...different.values()].sort((a, b) => a.operations.length - b.operations.length)) {
		const members = new Set(operations.filter((name) => boxes.has(name)));
		if (members.size < 2) continue;
		const around = boundsOf([...members].flatMap((name) => boxes.get(name) ?? []));
		const within = frames.filter((frame) => frame.members.size < members.size && [...frame.members].every((name) => members.has(name)));
		const isClear =
			[...boxes].every(([name, box]) => members.has(name) || !meet(box, around)) && frames.every((frame) => within.includes(frame) || !meet(frame, around));
		if (isClear) frames.push({ ...around, kind, members, depth: Math.max(0, ...within.map(({ depth }) => depth + 1)) });
		else for (const name of members) marks.set(name, [...new Set([...(marks.get(name) ?? []), kind])]);
	}
	return { frames: frames.map(({ x, y, width, height, kind, depth }) => ({ x, y, width, height, kind, depth })), marks };
}

function boundsOf(rects: readonly Rect[]): Rect {
	const [x, y] = [Math.min(...rects.map((each) => each.x)), Math.min(...rects.map((each) => each.y))];
	return { x, y, width: Math.max(...rects.map((each) => each.x + each.width)) - x, height: Math.max(...rects.map((each) => each.y + each.height)) - y };
}

function meet(a: Rect, b: Rect): boolean {
	return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}
