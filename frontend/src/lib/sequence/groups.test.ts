import fc from 'fast-check';
import { expect, test } from 'vitest';
import { drawnGroups, type Group, type Rect } from './groups.ts';

const box = (column: number, row: number): Rect => ({ x: column * 100, y: row * 60, width: 90, height: 50 });
const group = (kind: Group['kind'], ...operations: string[]): Group => ({ kind, operations, name: 'work', for_jobs: false });
const places = new Map(Object.entries({ a: box(0, 0), b: box(1, 0), c: box(2, 0), d: box(0, 1), e: box(2, 1) }));

test('a frame is around a group, and around the frames that lie in it', () => {
	const { frames, marks } = drawnGroups([group('parallel', 'a', 'b', 'c', 'd', 'e'), group('alternative', 'a', 'b'), group('alternative', 'b', 'a')], places);
	expect(frames).toEqual([
		{ kind: 'alternative', x: 0, y: 0, width: 190, height: 50, depth: 0 },
		{ kind: 'parallel', x: 0, y: 0, width: 290, height: 110, depth: 1 }
	]);
	expect(marks.size).toBe(0);
});

test('where a frame would have another operation in it, or cut another frame, each has a mark', () => {
	const { frames, marks } = drawnGroups([group('alternative', 'a', 'c'), group('parallel', 'a', 'b'), group('arbitrary', 'b', 'c'), group('parallel', 'x', 'y')], places);
	expect(frames.map(({ kind }) => kind)).toEqual(['parallel']);
	expect(Object.fromEntries(marks)).toEqual({ a: ['alternative'], b: ['arbitrary'], c: ['alternative', 'arbitrary'] });
});

test('frames never cut one another nor an operation that is not of them, and no group is left untold', () => {
	const names = [...places.keys()];
	const one = fc.record({ kind: fc.constantFrom('parallel', 'alternative', 'arbitrary'), operations: fc.uniqueArray(fc.constantFrom(...names), { minLength: 2 }) });
	fc.assert(
		fc.property(fc.array(one.map(({ kind, operations }) => group(kind, ...operations)), { maxLength: 5 }), (groups) => {
			const { frames, marks } = drawnGroups(groups, places);
			for (const { kind, operations } of groups) {
				const around = operations.map((name) => places.get(name)!);
				const left = Math.min(...around.map(({ x }) => x));
				const isFramed = frames.some((frame) => frame.kind === kind && frame.x === left && around.every((each) => each.x + each.width <= frame.x + frame.width));
				expect(isFramed || operations.every((name) => marks.get(name)?.includes(kind))).toBe(true);
			}
			for (const [at, first] of frames.entries())
				for (const second of frames.slice(at + 1)) {
					const apart = first.x + first.width <= second.x || second.x + second.width <= first.x || first.y + first.height <= second.y || second.y + second.height <= first.y;
					const inside = first.x >= second.x && first.y >= second.y && first.x + first.width <= second.x + second.width && first.y + first.height <= second.y + second.height;
					expect(apart || (inside && first.depth < second.depth)).toBe(true);
				}
		})
	);
});
