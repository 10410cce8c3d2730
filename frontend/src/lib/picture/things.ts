/** What can be moved in the picture of a station: the things of its file, and the pieces that each of them has. */
import type { Edit, Mimic, MimicPart } from '#lib/contract.ts';
import type { Box, Point } from '#lib/mimic/geometry.ts';
import { isWithin } from '#lib/mimic/geometry.ts';
import { PICTURE as FILE } from '#lib/model/tree.ts';
import { entriesOf, isList, valueAt, type Json, type Path } from '#lib/model/content.ts';

/** The size of what has none, as the documents say. */
const SIZE = { symbol: [163, 44], slot: [77, 64], drawing: [872, 346] } as const;
/** Of a part without a size. */
const PART = 16;
/** Units across a stop, where it is taken. */
const STOP = 16;

export type PieceKind = 'slot' | 'part' | 'stop';

/** Something on a thing that has a place of its own. */
export interface Piece {
	/** Its kind with its number or, of a stop, its value: the same for as long as it is there. */
	readonly id: string;
	readonly kind: PieceKind;
	/** Its own name: the value of a stop, the variable of a part; empty for a slot. */
	readonly name: string;
	/** The entry of the file in which its place is. */
	readonly path: Path;
	readonly at: Point;
	readonly box: Box;
}

/** A thing of the picture, as the file says it. */
export interface Thing {
	readonly name: string;
	readonly path: Path;
	readonly box: Box;
	readonly pieces: readonly Piece[];
	/** All of its stops lie on it: they go where it goes. */
	readonly carries: boolean;
}

/** A change of the place or the size of a thing, or of one of its pieces. */
export interface Shift {
	readonly thing: string;
	/** The piece, by its id; null for the thing, with all pieces that lie on it. */
	readonly piece: string | null;
	readonly dx: number;
	readonly dy: number;
	readonly wider: number;
	readonly higher: number;
}

function pointAt(content: Json | undefined, path: Path): Point | null {
	const value = valueAt(content, path);
	const [x, y] = isList(value) ? value : [];
	return typeof x === 'number' && typeof y === 'number' ? { x, y } : null;
}

function sizeAt(content: Json | undefined, path: Path, otherwise: readonly [number, number]): { width: number; height: number } {
	const found = pointAt(content, path);
	return { width: found?.x ?? otherwise[0], height: found?.y ?? otherwise[1] };
}

/** The width and height of the drawing. */
export function drawingSize(content: Json | undefined): { width: number; height: number } {
	return sizeAt(content, ['size'], SIZE.drawing);
}

/** The variable of a part without its index. */
const family = (variable: string): string => variable.replace(/\[[^\]]*\]$/, '');

/** The rectangle around the marks of all parts. */
function around(parts: readonly MimicPart[]): Box | null {
	const marks = parts.flatMap(({ marks, size }) => marks.map(([x, y]) => ({ x, y, r: size / 2 })));
	if (marks.length === 0) return null;
	const x = Math.min(...marks.map((each) => each.x - each.r));
	const y = Math.min(...marks.map((each) => each.y - each.r));
	return { x, y, width: Math.max(...marks.map((each) => each.x + each.r)) - x, height: Math.max(...marks.map((each) => each.y + each.r)) - y };
}

/** The things of the file from the back to the front; one without a place is left out. `drawn` tells how large parts are. */
export function thingsOf(content: Json | undefined, drawn: Pick<Mimic, 'symbols'> | null): Thing[] {
	return entriesOf(valueAt(content, ['symbols'])).flatMap(([name, symbol]): Thing[] => {
		const at = pointAt(symbol, ['at']);
		if (at === null) return [];
		const path = ['symbols', name];
		const box = { ...at, ...sizeAt(symbol, ['size'], SIZE.symbol) };
		const parts = drawn?.symbols.find((each) => each.name === name)?.parts ?? [];
		const listOf = (key: string): readonly Json[] => {
			const list = valueAt(symbol, [key]);
			return isList(list) ? list : [];
		};
		const slots = listOf('slots').flatMap((slot, number): Piece[] => {
			const place = pointAt(slot, ['at']);
			if (place === null) return [];
			return [{ id: `slot:${number}`, kind: 'slot', name: '', path: [...path, 'slots', number], at: place, box: { ...place, ...sizeAt(slot, ['size'], SIZE.slot) } }];
		});
		const onIt = listOf('parts').flatMap((part, number): Piece[] => {
			const place = pointAt(part, ['at']);
			if (place === null) return [];
			const of = String(valueAt(part, ['of']) ?? '');
			const size = Number(valueAt(part, ['size']) ?? PART);
			const own = around(parts.filter(({ variable }) => variable === of || family(variable) === of));
			const alone = { x: place.x - size / 2, y: place.y - size / 2, width: size, height: size };
			// How far its marks reach tells the drawing; where they begin, the file, which is ahead of it.
			const from = parts.find(({ variable }) => variable === of || family(variable) === of);
			const first = from?.marks[0];
			const [dx, dy] = own !== null && first !== undefined ? marksFrom(part, own, first) : [0, 0];
			return [{ id: `part:${number}`, kind: 'part', name: of, path: [...path, 'parts', number], at: place, box: own === null ? alone : { ...own, x: place.x + dx, y: place.y + dy } }];
		});
		const stops = entriesOf(valueAt(symbol, ['track', 'stops'])).flatMap(([value, stop]): Piece[] => {
			const place = pointAt(stop, ['at']);
			if (place === null) return [];
			return [{ id: `stop:${value}`, kind: 'stop', name: value, path: [...path, 'track', 'stops', value], at: place, box: { x: place.x - STOP / 2, y: place.y - STOP / 2, width: STOP, height: STOP } }];
		});
		const carries = stops.length > 0 && stops.every(({ at: { x, y } }) => isWithin({ x, y, width: 0, height: 0 }, box));
		return [{ name, path, box, pieces: [...slots, ...onIt, ...stops], carries }];
	});
}

/** From the place of a part to the corner of the rectangle around its marks. */
function marksFrom(part: Json, own: Box, first: readonly number[]): [number, number] {
	const mark = pointAt(part, ['marks', 0]) ?? { x: 0, y: 0 };
	return [own.x - ((first[0] ?? 0) - mark.x), own.y - ((first[1] ?? 0) - mark.y)];
}

/** Whether a piece goes where its thing goes: stops beyond it stay, as they are places of the station. */
function goesAlong(thing: Thing, { kind }: Piece): boolean {
	return kind !== 'stop' || thing.carries;
}

const moved = <Place extends Point>(place: Place, dx: number, dy: number): Place => ({ ...place, x: place.x + dx, y: place.y + dy });

function shiftedBox(box: Box, { dx, dy, wider, higher }: Shift): Box {
	return { x: box.x + dx, y: box.y + dy, width: box.width + wider, height: box.height + higher };
}

/** A thing after a change of its place. */
export function shiftedThing(thing: Thing, shift: Shift): Thing {
	if (shift.thing !== thing.name) return thing;
	const pieces = thing.pieces.map((piece) => {
		if (shift.piece === piece.id) return { ...piece, at: moved(piece.at, shift.dx, shift.dy), box: shiftedBox(piece.box, shift) };
		if (shift.piece !== null || !goesAlong(thing, piece)) return piece;
		return { ...piece, at: moved(piece.at, shift.dx, shift.dy), box: moved(piece.box, shift.dx, shift.dy) };
	});
	return { ...thing, pieces, box: shift.piece === null ? shiftedBox(thing.box, shift) : thing.box };
}

/** The picture after a change of the place of a thing as it was before: as it is drawn until the station has drawn it anew. */
export function shiftedPicture(mimic: Mimic, thing: Thing, shift: Shift): Mimic {
	const { dx, dy, wider, higher } = shift;
	const piece = thing.pieces.find(({ id }) => id === shift.piece) ?? null;
	const goes = (each: Piece | undefined): boolean =>
		each !== undefined && (shift.piece === null ? goesAlong(thing, each) : each.id === shift.piece);
	const slotAt = ({ x, y }: Point): Piece | undefined => thing.pieces.find(({ kind, at }) => kind === 'slot' && at.x === x && at.y === y);
	const partOf = (variable: string): Piece | undefined =>
		thing.pieces.find(({ kind, name }) => kind === 'part' && (name === variable || name === family(variable)));
	const stopOf = (value: string): Piece | undefined => thing.pieces.find(({ kind, name }) => kind === 'stop' && name === value);
	const symbols = mimic.symbols.map((symbol) => {
		if (symbol.name !== thing.name) return symbol;
		return {
			...symbol,
			box: shift.piece === null ? shiftedBox(symbol.box, shift) : symbol.box,
			slots: symbol.slots.map((slot) => {
				if (!goes(slotAt(slot.box))) return slot;
				const [w, h] = piece?.kind === 'slot' ? [wider, higher] : [0, 0];
				return { ...slot, box: shiftedBox(slot.box, { ...shift, wider: w, higher: h }) };
			}),
			parts: symbol.parts.map((part) =>
				goes(partOf(part.variable))
					? { ...part, label_x: part.label_x + dx, label_y: part.label_y + dy, marks: part.marks.map(([x, y]): [number, number] => [x + dx, y + dy]) }
					: part
			),
			track: symbol.track && { ...symbol.track, stops: symbol.track.stops.map((stop) => (goes(stopOf(stop.value)) ? moved(stop, dx, dy) : stop)) }
		};
	});
	return { ...mimic, symbols };
}

/** So many digits behind the point: no noise of binary fractions comes into the file. */
export const tidy = (number: number): number => Math.round(number * 100) / 100;

/** An edit of what of two numbers at `path` is another one; of what is not there, one that adds both. */
function edited(content: Json | undefined, path: Path, now: readonly [number, number], otherwise: readonly [number, number] | null): Edit[] {
	const was = valueAt(content, path);
	const [x, y] = [tidy(now[0]), tidy(now[1])];
	if (!isList(was)) return otherwise !== null && otherwise[0] === x && otherwise[1] === y ? [] : [{ kind: 'add', file: FILE, path: [...path], value: [x, y] }];
	// Who moves it down goes together with who moves it to the side.
	if (was[1] === y) return was[0] === x ? [] : [{ kind: 'set', file: FILE, path: [...path, 0], was: was[0] ?? null, value: x }];
	if (was[0] === x) return [{ kind: 'set', file: FILE, path: [...path, 1], was: was[1] ?? null, value: y }];
	return [{ kind: 'set', file: FILE, path: [...path], was, value: [x, y] }];
}

/** The edits of the file that make a change of a place: only numbers become others. */
export function editsOf(content: Json | undefined, thing: Thing, shift: Shift): Edit[] {
	const after = shiftedThing(thing, shift);
	const places: { readonly path: Path; readonly at: Point }[] = [{ path: after.path, at: after.box }, ...after.pieces];
	const edits = places.flatMap(({ path, at }) => edited(content, [...path, 'at'], [at.x, at.y], null));
	if (shift.wider === 0 && shift.higher === 0) return edits;
	const resized = shift.piece === null ? after : after.pieces.find(({ id }) => id === shift.piece);
	if (resized === undefined) return edits;
	const size = shift.piece === null ? SIZE.symbol : SIZE.slot;
	return [...edits, ...edited(content, [...resized.path, 'size'], [resized.box.width, resized.box.height], [...size])];
}

/** A copy of a symbol as it is written, so much beside it. */
export function copyBeside(symbol: Json, by: number): Json {
	const move = (value: Json): Json => {
		if (isList(value)) return value.map(move);
		if (typeof value !== 'object' || value === null) return value;
		return Object.fromEntries(
			Object.entries(value).map(([key, each]) => {
				const at = key === 'at' ? pointAt(value, ['at']) : null;
				return [key, at === null ? move(each) : [tidy(at.x + by), tidy(at.y + by)]];
			})
		);
	};
	return move(symbol);
}

/** A name like `name` that is not taken. */
export function freeName(name: string, taken: readonly string[]): string {
	const base = name.replace(/_\d+$/, '');
	if (!taken.includes(name)) return name;
	for (let number = 2; ; number++) if (!taken.includes(`${base}_${number}`)) return `${base}_${number}`;
}

/** Where something of this size lies on nothing else: from the top left, row by row; else in the corner. */
export function freePlace(things: readonly Thing[], drawing: { width: number; height: number }, [width, height]: readonly [number, number]): [number, number] {
	const GAP = 10;
	for (let y = GAP; y + height <= drawing.height; y += GAP)
		for (let x = GAP; x + width <= drawing.width; x += GAP) {
			const isFree = [...things.map(({ box }) => box), ...things.flatMap(({ pieces }) => pieces.map(({ box }) => box))].every(
				(box) => x >= box.x + box.width || box.x >= x + width || y >= box.y + box.height || box.y >= y + height
			);
			if (isFree) return [x, y];
		}
	return [GAP, GAP];
}
