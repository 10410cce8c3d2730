import fc from 'fast-check';
import { expect, test } from 'vitest';
import { viewportOf } from './viewport.ts';

const ROOM = { width: 800, height: 400 };

test('a small picture is in the middle at its own size', () => {
	expect(viewportOf({ width: 200, height: 100 }, ROOM, 1, { x: 0, y: 0 })).toEqual({ x: 300, y: 150, zoom: 1 });
});

test('one that is larger begins as large as it can be read, at what it is about', () => {
	expect(viewportOf({ width: 4000, height: 4000 }, ROOM, 1, { x: 2000, y: 1000 })).toEqual({ x: -1600, y: -800, zoom: 1 });
	expect(viewportOf({ width: 4000, height: 4000 }, ROOM, 1, { x: 10, y: 3990 })).toEqual({ x: 0, y: -3600, zoom: 1 });
});

test('all of it is in sight where it may be small', () => {
	expect(viewportOf({ width: 4000, height: 1000 }, ROOM, 0, { x: 3000, y: 0 })).toEqual({ x: 0, y: 100, zoom: 0.2 });
});

test('what it is about is always in sight, and no more room is empty than has to be', () => {
	const size = fc.record({ width: fc.integer({ min: 1, max: 9000 }), height: fc.integer({ min: 1, max: 9000 }) });
	fc.assert(
		fc.property(size, size, fc.constantFrom(0, 0.5, 1), fc.double({ min: 0, max: 1, noNaN: true }), fc.double({ min: 0, max: 1, noNaN: true }), (picture, room, least, right, down) => {
			const about = { x: right * picture.width, y: down * picture.height };
			const { x, y, zoom } = viewportOf(picture, room, least, about);
			expect(zoom).toBeGreaterThanOrEqual(least);
			for (const [at, offset, has, whole] of [
				[about.x, x, room.width, picture.width],
				[about.y, y, room.height, picture.height]
			] as const) {
				expect(at * zoom + offset).toBeGreaterThanOrEqual(-1e-6);
				expect(at * zoom + offset).toBeLessThanOrEqual(has + 1e-6);
				if (whole * zoom > has) expect(offset).toBeLessThanOrEqual(0);
				if (whole * zoom > has) expect(offset + whole * zoom).toBeGreaterThanOrEqual(has - 1e-6);
			}
		})
	);
});
