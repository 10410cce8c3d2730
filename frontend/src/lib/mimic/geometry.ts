/** Where things are in the picture, and along which lines they move. */
import type { Mimic, MimicStop, MimicTrack } from '#lib/contract.ts';
import type { Whereabouts } from './live.ts';

export interface Point {
	readonly x: number;
	readonly y: number;
}

export type Box = Mimic['symbols'][number]['box'];

/** Points at which a bent way is known. */
const PIECES = 12;

/** A way as SVG draws it: straight along the line and straight down, bent to what lies beside it. */
export function wayPath(from: Point, to: Point): string {
	const [start, end] = downwards(from, to);
	if (start.x === end.x || start.y === end.y) return `M${start.x} ${start.y}L${end.x} ${end.y}`;
	const [first, second] = bends(start, end);
	return `M${start.x} ${start.y}C${first.x} ${first.y} ${second.x} ${second.y} ${end.x} ${end.y}`;
}

/** The points of a way from one of its ends to the other. */
export function wayPoints(from: Point, to: Point): Point[] {
	if (from.x === to.x || from.y === to.y) return [from, to];
	const [start, end] = downwards(from, to);
	const [first, second] = bends(start, end);
	const points = Array.from({ length: PIECES + 1 }, (_, number) => {
		const t = number / PIECES;
		const u = 1 - t;
		const of = (axis: keyof Point): number =>
			u ** 3 * start[axis] + 3 * u * u * t * first[axis] + 3 * u * t * t * second[axis] + t ** 3 * end[axis];
		return { x: of('x'), y: of('y') };
	});
	return start === from ? points : points.reverse();
}

/** The end that lies higher comes first: ways are bent alike in both directions. */
function downwards(a: Point, b: Point): [Point, Point] {
	return a.y <= b.y ? [a, b] : [b, a];
}

function bends(start: Point, end: Point): [Point, Point] {
	const height = end.y - start.y;
	return [
		{ x: start.x, y: start.y + height / 2 },
		{ x: end.x, y: end.y - height * 0.6 }
	];
}

/** The stops from one to another along the ways, the fewest; straight where no way leads there. */
export function route(track: Pick<MimicTrack, 'ways'>, from: string, to: string): string[] {
	const before = new Map<string, string | null>([[from, null]]);
	const waiting = [from];
	for (let at = waiting.shift(); at !== undefined && !before.has(to); at = waiting.shift())
		for (const [a, b] of track.ways) {
			const next = a === at ? b : b === at ? a : null;
			if (next === null || before.has(next)) continue;
			before.set(next, at);
			waiting.push(next);
		}
	if (!before.has(to)) return [from, to];
	const found: string[] = [];
	for (let at: string | null = to; at !== null; at = before.get(at) ?? null) found.unshift(at);
	return found;
}

/** The points of the ways along these stops. */
export function along(stops: readonly MimicStop[], names: readonly string[]): Point[] {
	const at = new Map(stops.map((stop) => [stop.value, stop]));
	const found: Point[] = [];
	for (const [number, name] of names.entries()) {
		const here = at.get(name);
		if (here === undefined) continue;
		const last = number > 0 ? at.get(names[number - 1] ?? '') : undefined;
		found.push(...(last === undefined ? [{ x: here.x, y: here.y }] : wayPoints(last, here).slice(1)));
	}
	return found.map(({ x, y }) => ({ x, y }));
}

/** How far it is along the points. */
export function lengthOf(points: readonly Point[]): number {
	return points.slice(1).reduce((sum, point, number) => sum + distance(points[number] ?? point, point), 0);
}

function distance(a: Point, b: Point): number {
	return Math.hypot(a.x - b.x, a.y - b.y);
}

/** The first part of a line, as much of its length as `part` says from 0 to 1. */
export function firstPart(points: readonly Point[], part: number): Point[] {
	let left = lengthOf(points) * part;
	const found = points.slice(0, 1);
	for (const [number, point] of points.slice(1).entries()) {
		const last = points[number] ?? point;
		const far = distance(last, point);
		if (far >= left) {
			const share = far === 0 ? 0 : left / far;
			return [...found, { x: last.x + (point.x - last.x) * share, y: last.y + (point.y - last.y) * share }];
		}
		left -= far;
		found.push(point);
	}
	return found;
}

/** A line as SVG draws it. */
export function linePath(points: readonly Point[]): string {
	return points.map(({ x, y }, number) => `${number === 0 ? 'M' : 'L'}${round(x)} ${round(y)}`).join('');
}

function round(value: number): number {
	return Math.round(value * 10) / 10;
}

/** Where something is drawn: at its stop, or halfway on the ways to where it goes, as nobody measures how far it is. */
export function placeOf(track: MimicTrack, at: Whereabouts): Point | null {
	return onTheWay(track, at).at(-1) ?? null;
}

/** All places at which it may be drawn: its stops, and halfway between those with a way between them. */
export function placesOf(track: MimicTrack): Point[] {
	const between = track.ways.map(([from, to]) => placeOf(track, { from, to, kind: 'moving' }));
	return [...track.stops, ...between].flatMap((place) => (place ? [{ x: place.x, y: place.y }] : []));
}

/** The edge that cuts nothing: above `edge` where something that reaches as far as `reach` around one of `places` is on it. */
export function uncut(places: readonly number[], edge: number, reach: number): number {
	return places.toSorted((a, b) => b - a).reduce((found, place) => (Math.abs(place - found) < reach ? place - reach : found), edge);
}

/** The points of a movement from one whereabouts to the next, along the ways where it went there. */
export function movement(track: MimicTrack, before: Whereabouts, after: Whereabouts): Point[] {
	if (before.to === before.from) return [...along(track.stops, route(track, before.to, after.from)), ...onTheWay(track, after).slice(1)];
	const rest = (to: string, from: string): Point[] => onTheWay(track, { from: to, to: from, kind: 'moving' }).reverse();
	if (after.to === after.from && after.to === before.to) return rest(before.to, before.from);
	if (after.to === after.from && after.to === before.from) return onTheWay(track, before).reverse();
	return [onTheWay(track, before), onTheWay(track, after)].flatMap((points) => points.slice(-1));
}

function onTheWay(track: MimicTrack, { from, to }: Whereabouts): Point[] {
	const points = along(track.stops, route(track, from, to));
	return from === to ? points : firstPart(points, 0.5);
}

/** The steps of a movement along the points, each at its share of the way. */
export function steps(points: readonly Point[]): { transform: string; offset: number }[] {
	const whole = lengthOf(points);
	let gone = 0;
	return points.map((point, number) => {
		gone += number > 0 ? distance(points[number - 1] ?? point, point) : 0;
		const offset = whole === 0 ? (number === 0 ? 0 : 1) : Math.min(1, gone / whole);
		return { transform: `translate(${point.x}px, ${point.y}px)`, offset };
	});
}

/** How long a movement takes in milliseconds: soon over, so that the picture is never far behind the station. */
export function duration(points: readonly Point[]): number {
	return Math.min(900, 260 + lengthOf(points));
}

export type Direction = 'ArrowLeft' | 'ArrowRight' | 'ArrowUp' | 'ArrowDown';
const DIRECTIONS: Readonly<Record<Direction, readonly [number, number]>> = {
	ArrowLeft: [-1, 0],
	ArrowRight: [1, 0],
	ArrowUp: [0, -1],
	ArrowDown: [0, 1]
};

export function isDirection(key: string): key is Direction {
	return Object.hasOwn(DIRECTIONS, key);
}

/** The box that is next in a direction: rather straight ahead than near; none where nothing is there. */
export function nextBox(boxes: readonly Box[], from: number, key: Direction): number {
	const here = boxes[from];
	if (here === undefined) return boxes.length > 0 ? 0 : -1;
	const [dx, dy] = DIRECTIONS[key];
	let best = -1;
	let least = Infinity;
	for (const [number, box] of boxes.entries()) {
		const x = box.x + box.width / 2 - here.x - here.width / 2;
		const y = box.y + box.height / 2 - here.y - here.height / 2;
		const ahead = x * dx + y * dy;
		const cost = ahead + 2 * Math.abs(x * dy + y * dx);
		if (number === from || ahead <= 1 || cost >= least) continue;
		best = number;
		least = cost;
	}
	return best;
}

/** The part of the picture that a small screen has room for: the product, and what stands above and below it. */
export function crop(mimic: Pick<Mimic, 'width' | 'height' | 'symbols'>): Box | null {
	const product = mimic.symbols.find((symbol) => symbol.parts.length > 0);
	if (product === undefined) return null;
	const x = Math.max(0, product.box.x - 14);
	const width = Math.min(mimic.width, product.box.x + product.box.width + 14) - x;
	const within = mimic.symbols.filter(({ box }) => box.x >= x && box.x + box.width <= x + width);
	const bottom = Math.max(...within.map(({ box }) => box.y + box.height)) + 12;
	return { x, y: 0, width, height: Math.min(mimic.height, bottom) };
}

export function isWithin(box: Box, around: Box): boolean {
	return (
		box.x >= around.x &&
		box.y >= around.y &&
		box.x + box.width <= around.x + around.width &&
		box.y + box.height <= around.y + around.height
	);
}

/** Whether a thing is drawn in a part of the picture: its card is in it, and so is what stands on its track. */
export function isDrawn(box: Box, stands: Point | null, shown: Box): boolean {
	return isWithin(box, shown) && (stands === null || isWithin({ ...stands, width: 0, height: 0 }, shown));
}
