/** What moves on a track and is somewhere else than in the part of the picture that is shown. */
import { isWithin, type Box } from './geometry.ts';
import type { Told } from './told.ts';

export interface Away {
	readonly name: string;
	readonly title: string;
	/** Where it is, or what it does. */
	readonly text: string;
	/** On which side of what is shown. */
	readonly left: boolean;
}

const isAt = (point: { readonly x: number; readonly y: number }, shown: Box): boolean => isWithin({ x: point.x, y: point.y, width: 0, height: 0 }, shown);

/** Of a track of which a part is shown: where it ends is asked for. */
export function awayOf(told: readonly Told[], shown: Box): Away[] {
	return told.flatMap(({ symbol, title, now, stands }) => {
		const partly = symbol.track?.stops.some((stop) => isAt(stop, shown));
		if (!partly || stands === null || isAt(stands, shown)) return [];
		return [{ name: symbol.name, title, text: now.text, left: stands.x < shown.x + shown.width / 2 }];
	});
}
