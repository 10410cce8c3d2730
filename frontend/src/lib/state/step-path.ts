/** The line of a variable over the last minute: a step wherever its value changed, and nothing where it was unknown. */
import { WINDOW, type Stretch } from '#lib/stream/recorder.ts';

export interface Size {
	readonly width: number;
	readonly height: number;
}

/** The `d` of an SVG path, for a domain of `places` values. The last of them is on top, the present on the right. */
export function stepPath(stretches: readonly Stretch[], places: number, now: number, { width, height }: Size): string {
	const xOf = (at: number): number => round(Math.min(1, Math.max(0, 1 - (now - at) / WINDOW)) * width);
	// What never changed has no height to be read.
	const constant = stretches.every(({ low, high, last }) => low === high && last === stretches[0]?.last && (low === last || Number.isNaN(low)));
	const yOf = (place: number): number => round(places < 2 || constant ? height / 2 : height * (1 - place / (places - 1)));
	let path = '';
	let pen = false;
	const to = (x: number, place: number): void => {
		path += pen ? `V${yOf(place)}` : `M${x} ${yOf(place)}`;
		pen = true;
	};
	for (const { at, low, high, last } of stretches) {
		const x = xOf(at);
		if (pen) path += `H${x}`;
		// Where it was known for a moment only there is no place to draw that but a line upright.
		if (!Number.isNaN(low)) {
			if (low !== last) to(x, low);
			if (high !== last && high !== low) to(x, high);
		}
		if (Number.isNaN(last)) pen = false;
		else to(x, last);
	}
	return pen ? `${path}H${round(width)}` : path;
}

/** How often it changed within the last minute. */
export function changesOf(stretches: readonly Stretch[], now: number): number {
	return stretches.reduce((sum, { at, changes }) => (at >= now - WINDOW ? sum + changes : sum), 0);
}

function round(length: number): number {
	return Math.round(length * 10) / 10;
}
