/** What of the graph lies under the pointer, for what is dropped there. */
import type { Picture, Spot } from './picture.ts';

/** The MIME type of a kind of stage that is dragged from the palette. */
export const STAGE = 'application/x-sequence-planner-stage';

/** Pixels around the pointer in which a wire is found too. */
const AROUND = [[0, 0], [14, 0], [-14, 0], [0, 14], [0, -14], [24, 0], [-24, 0], [0, 24], [0, -24]] as const;

/** The wire there; null for none. */
export function wireAt(x: number, y: number, picture: Picture): Picture['wires'][number] | null {
	const known = new Map(picture.wires.map((wire) => [wire.id, wire]));
	for (const [right, down] of AROUND)
		for (const element of document.elementsFromPoint(x + right, y + down)) {
			const id = element.closest<HTMLElement>('[data-wire]')?.dataset['wire'] ?? element.closest('.svelte-flow__edge')?.getAttribute('data-id');
			const wire = id === undefined || id === null ? undefined : known.get(id);
			if (wire) return wire;
		}
	return null;
}

/** The edge at which something comes to stand that is dropped there: on a wire, behind a box, or before a message that is sent. */
export function spotAt(x: number, y: number, picture: Picture): Spot | null {
	const wire = wireAt(x, y, picture);
	if (wire) return wire.spot;
	const id = document.elementsFromPoint(x, y).map((element) => element.closest<HTMLElement>('.svelte-flow__node')?.dataset['id']).find(Boolean);
	const box = picture.boxes.find((each) => each.id === id);
	// What a variable is written by, or what reads it, ends or begins there.
	return box?.spot ?? picture.wires.find(({ from, to }) => box?.kind === 'variable' && (from === id || to === id))?.spot ?? null;
}
