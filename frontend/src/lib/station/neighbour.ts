/** Where an arrow key leads on a map whose things stand in rows, as they are seen. */

export type Arrow = 'ArrowLeft' | 'ArrowRight' | 'ArrowUp' | 'ArrowDown' | 'Home' | 'End';

interface Box {
	readonly left: number;
	readonly right: number;
	readonly top: number;
	readonly bottom: number;
}

interface Boxed {
	getBoundingClientRect(): Box;
}

/** Pixels by which boxes of one row may differ. */
const ROW = 8;

/** The one to which `key` leads from `from`, among all in the order of the document; null where it leads nowhere. */
export function next<One extends Boxed>(all: readonly One[], from: unknown, key: Arrow): One | null {
	const at = all.findIndex((each) => each === from);
	const here = all[at];
	if (here === undefined) return null;
	switch (key) {
		case 'ArrowLeft':
			return all[at - 1] ?? null;
		case 'ArrowRight':
			return all[at + 1] ?? null;
		case 'Home':
			return all[0] ?? null;
		case 'End':
			return all.at(-1) ?? null;
		case 'ArrowUp':
			return nearest(all.slice(0, at).reverse(), here.getBoundingClientRect(), (box, own) => own.top - box.bottom);
		case 'ArrowDown':
			return nearest(all.slice(at + 1), here.getBoundingClientRect(), (box, own) => box.top - own.bottom);
		default:
			return null;
	}
}

/** Of those in the first row beyond, the one that is least to the side. */
function nearest<One extends Boxed>(others: readonly One[], own: Box, beyond: (box: Box, own: Box) => number): One | null {
	let found: One | null = null;
	let aside = Infinity;
	let row: number | null = null;
	for (const other of others) {
		const box = other.getBoundingClientRect();
		if (beyond(box, own) < -ROW) continue;
		row ??= box.top;
		if (Math.abs(box.top - row) > ROW) break;
		const distance = Math.max(box.left - own.right, own.left - box.right, 0) + Math.abs(box.left - own.left) / 1000;
		if (distance < aside) [found, aside] = [other, distance];
	}
	return found;
}
