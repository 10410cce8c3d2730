/** What of a picture is in sight. */
import type { Point } from './layout.ts';

interface Size {
	readonly width: number;
	readonly height: number;
}

/** Where the picture lies in its room, and at which scale. */
export interface Viewport extends Point {
	readonly zoom: number;
}

/**
 * All of a picture at no more than its own size; or, where it would be smaller than `least` then, as much of it as there is room
 * for, with `about` in the middle as far as the picture reaches.
 */
export function viewportOf(picture: Size, room: Size, least: number, about: Point): Viewport {
	const zoom = Math.min(1, Math.max(least, Math.min(room.width / picture.width, room.height / picture.height)));
	const place = (size: number, has: number, at: number): number => {
		const spare = has - size * zoom;
		return spare >= 0 ? spare / 2 : Math.min(0, Math.max(spare, has / 2 - at * zoom));
	};
	return { x: place(picture.width, room.width, about.x), y: place(picture.height, room.height, about.y), zoom };
}
