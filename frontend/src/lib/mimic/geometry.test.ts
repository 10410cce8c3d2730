import * as fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import type { MimicStop, MimicTrack } from '#lib/contract.ts';
import { along, crop, duration, firstPart, lengthOf, movement, nextBox, placeOf, placesOf, route, steps, uncut, wayPath, wayPoints, type Point } from './geometry.ts';
import { fit } from '#lib/wording/measure.svelte.ts';

const stop = (value: string, x: number, y: number): MimicStop => ({ value, title: {}, x, y, label: 'above', room: 100, branch: y > 0 });
/** A line from home over above to far, with two branches below above. */
const TRACK: MimicTrack = {
	position: 'robot.at',
	target: 'robot.to',
	previous: null,
	stops: [stop('home', 0, 0), stop('above', 100, 0), stop('far', 300, 0), stop('left', 60, 80), stop('right', 140, 80)],
	ways: [
		['home', 'above'],
		['above', 'far'],
		['above', 'left'],
		['above', 'right']
	]
};
const there = (at: string) => ({ from: at, to: at, kind: 'there' as const });
const moving = (from: string, to: string) => ({ from, to, kind: 'moving' as const });
const points = fc.array(fc.record({ x: fc.integer({ min: -500, max: 500 }), y: fc.integer({ min: -500, max: 500 }) }), { minLength: 1, maxLength: 12 });

describe('ways', () => {
	it('are straight along the line and straight down, and bent to what lies beside it', () => {
		expect(wayPath({ x: 0, y: 0 }, { x: 9, y: 0 })).toBe('M0 0L9 0');
		expect(wayPath({ x: 9, y: 8 }, { x: 9, y: 0 })).toBe('M9 0L9 8');
		expect(wayPath({ x: 0, y: 0 }, { x: 40, y: 80 })).toMatch(/^M0 0C0 40 40 32 40 80$/);
	});

	it('lead over the fewest stops, in either direction', () => {
		expect(route(TRACK, 'left', 'far')).toEqual(['left', 'above', 'far']);
		expect(route(TRACK, 'far', 'left')).toEqual(['far', 'above', 'left']);
		expect(route(TRACK, 'left', 'nowhere')).toEqual(['left', 'nowhere']);
		expect(route(TRACK, 'left', 'left')).toEqual(['left']);
	});

	it('begin and end where the stops are, and are the same line back', () => {
		fc.assert(
			fc.property(points, points, ([a], [b]) => {
				if (!a || !b) return;
				const line = wayPoints(a, b);
				expect([line[0], line.at(-1)]).toEqual([a, b].map((point) => ({ x: expect.closeTo(point.x), y: expect.closeTo(point.y) })));
				for (const [number, { x, y }] of wayPoints(b, a).reverse().entries())
					expect(line[number]).toEqual({ x: expect.closeTo(x), y: expect.closeTo(y) });
			})
		);
	});
});

describe('movements', () => {
	it('go along the ways from where it stood to where it stands', () => {
		const all = movement(TRACK, there('left'), there('right'));
		expect(all[0]).toEqual({ x: 60, y: 80 });
		expect(all.at(-1)).toEqual({ x: 140, y: 80 });
		expect(all).toContainEqual({ x: 100, y: 0 });
	});

	it('stop halfway as long as nobody says that it has arrived, and then go on', () => {
		const half = placeOf(TRACK, moving('home', 'above'));
		expect(half).toEqual({ x: 50, y: 0 });
		expect(movement(TRACK, there('home'), moving('home', 'above'))).toEqual([{ x: 0, y: 0 }, half]);
		expect(movement(TRACK, moving('home', 'above'), there('above'))).toEqual([half, { x: 100, y: 0 }]);
		expect(movement(TRACK, moving('home', 'above'), there('home'))).toEqual([half, { x: 0, y: 0 }]);
	});

	it('end where the thing is drawn afterwards, whatever has happened', () => {
		const names = TRACK.stops.map((each) => each.value);
		const where = fc
			.tuple(fc.constantFrom(...names), fc.constantFrom(...names))
			.map(([from, to]) => (from === to ? there(to) : moving(from, to)));
		fc.assert(
			fc.property(where, where, (before, after) => {
				const line = movement(TRACK, before, after);
				const close = (point: Point | null) => point && { x: expect.closeTo(point.x, 3), y: expect.closeTo(point.y, 3) };
				expect(line.at(-1)).toEqual(close(placeOf(TRACK, after)));
				expect(line[0]).toEqual(close(placeOf(TRACK, before)));
			})
		);
	});

	it('have steps in order from the beginning to the end, and are soon over', () => {
		fc.assert(
			fc.property(points, (line) => {
				const offsets = steps(line).map(({ offset }) => offset);
				expect(offsets).toEqual(offsets.toSorted((a, b) => a - b));
				expect(offsets.every((offset) => offset >= 0 && offset <= 1)).toBe(true);
				expect(duration(line)).toBeLessThanOrEqual(900);
			})
		);
	});

	it('of which a part is as long as is said', () => {
		fc.assert(
			fc.property(points, fc.double({ min: 0, max: 1, noNaN: true }), (line, part) => {
				expect(lengthOf(firstPart(line, part))).toBeCloseTo(lengthOf(line) * part, 3);
			})
		);
	});

	it('leave out stops that are not drawn', () => {
		expect(along(TRACK.stops, ['home', 'gone', 'above'])).toEqual([
			{ x: 0, y: 0 },
			{ x: 100, y: 0 }
		]);
	});
});

describe('the picture', () => {
	const box = (x: number, y: number) => ({ x, y, width: 100, height: 40 });

	it('is gone through with the arrow keys, straight ahead first', () => {
		const boxes = [box(0, 0), box(200, 0), box(0, 100), box(210, 100)];
		expect(nextBox(boxes, 0, 'ArrowRight')).toBe(1);
		expect(nextBox(boxes, 0, 'ArrowDown')).toBe(2);
		expect(nextBox(boxes, 3, 'ArrowUp')).toBe(1);
		expect(nextBox(boxes, 0, 'ArrowLeft')).toBe(-1);
		expect(nextBox([], 0, 'ArrowLeft')).toBe(-1);
	});

	it('is cropped to the product and what stands above and below it', () => {
		const symbol = (name: string, x: number, y: number, parts: number) => ({
			name,
			box: box(x, y),
			parts: Array.from({ length: parts }, () => ({}))
		});
		const symbols = [symbol('left', 0, 60, 0), symbol('product', 200, 60, 1), symbol('person', 200, 120, 0)];
		const mimic = { width: 500, height: 400, symbols } as unknown as Parameters<typeof crop>[0];
		expect(crop(mimic)).toEqual({ x: 186, y: 0, width: 128, height: 172 });
		expect(crop({ ...mimic, symbols: [] })).toBeNull();
	});

	it('cuts texts to the room they have, and says so', () => {
		fc.assert(
			fc.property(fc.string({ maxLength: 120 }), fc.integer({ min: 1, max: 110 }), (text, room) => {
				const shown = fit(text, room, 'strong', (each) => each.length);
				expect(shown.length).toBeLessThanOrEqual(Math.max(1, room));
				if (text.length <= room) expect(shown).toBe(text);
				else {
					const cut = shown.lastIndexOf('…');
					expect(text.startsWith(shown.slice(0, cut))).toBe(true);
					expect(text.endsWith(shown.slice(cut + 1))).toBe(true);
				}
			})
		);
	});

	it('keeps both ends of a long name: they tell it from others', () => {
		const name = (number: number) => `${'Donaudampfschiffahrtselektrizität'.repeat(3)} part 0${number}`;
		const shown = (number: number) => fit(name(number), 80, 'strong', (each) => each.length);
		expect(shown(1)).toMatch(/^Donau.*…part 01$/);
		expect(shown(1)).not.toBe(shown(2));
		expect(fit('Tool for the ladder frame', 12, 'strong', (each) => each.length)).toBe('Tool for th…');
	});
});

describe('the edge of a part of the picture', () => {
	it('knows all places at which it is drawn', () => {
		const places = placesOf({ ...TRACK, stops: TRACK.stops.slice(0, 3) });
		expect(places.slice(3)).toContainEqual({ x: 50, y: 0 });
		expect(places.slice(3)).toContainEqual({ x: 200, y: 0 });
	});

	it('cuts nothing that may be drawn on it', () => {
		expect(uncut([100, 20], 60, 26)).toBe(60);
		expect(uncut([50], 60, 26)).toBe(24);
		expect(uncut([70], 60, 26)).toBe(44);
		// What is above it then may be cut by the new edge.
		expect(uncut([30, 50], 60, 26)).toBe(4);
		fc.assert(
			fc.property(fc.array(fc.integer({ min: 0, max: 300 }), { maxLength: 9 }), fc.integer({ min: 0, max: 300 }), (places, edge) => {
				const found = uncut(places, edge, 20);
				expect(found).toBeLessThanOrEqual(edge);
				for (const place of places) expect(Math.abs(place - found)).toBeGreaterThanOrEqual(20);
			})
		);
	});
});
