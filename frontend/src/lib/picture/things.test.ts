import { expect, test } from 'vitest';
import type { Edit, Mimic } from '#lib/contract.ts';
import { valueAt, type Json } from '#lib/model/content.ts';
import { resized, snapped } from './snapping.ts';
import { copyBeside, editsOf, freeName, freePlace, shiftedPicture, thingsOf, type Shift, type Thing } from './things.ts';

const content: Json = {
	symbols: {
		dock: { at: [20, 100], size: [184, 96], slots: [{ at: [30, 110], title: 'Tool', holds: { tool: true } }] },
		engine: { at: [300, 100], parts: [{ of: 'bolts', at: [340, 150], marks: [[0, -10], [0, 44]] }] },
		agv: { at: [600, 200], size: [126, 84], track: { of: 'agv.at', stops: { here: { at: [620, 270] }, there: { at: [700, 270] } } } },
		robot: { at: [500, 8], track: { of: 'robot.pose', stops: { home: { at: [70, 76] }, above: { at: [515, 76] } } } }
	}
};
const stop = (value: string, x: number, y: number): object => ({ value, title: {}, x, y, label: 'above', room: 120, branch: false });
const symbol = (name: string, box: object, rest: object = {}): object => ({ name, box, slots: [], parts: [], track: null, ...rest });
const mimic = {
	symbols: [
		symbol('dock', { x: 20, y: 100, width: 184, height: 96 }, { slots: [{ box: { x: 30, y: 110, width: 77, height: 64 } }] }),
		symbol('engine', { x: 300, y: 100, width: 163, height: 44 }, {
			parts: [0, 39].map((dx, number) => ({ variable: `bolts[pair_${number}]`, marks: [[340 + dx, 140], [340 + dx, 194]], size: 16, label_x: 340 + dx, label_y: 171 }))
		}),
		symbol('agv', { x: 600, y: 200, width: 126, height: 84 }, { track: { stops: [stop('here', 620, 270), stop('there', 700, 270)] } }),
		symbol('robot', { x: 500, y: 8, width: 163, height: 44 }, { track: { stops: [stop('home', 70, 76), stop('above', 515, 76)] } })
	]
} as unknown as Mimic;

const thing = (name: string): Thing => {
	const found = thingsOf(content, mimic).find((each) => each.name === name);
	if (found === undefined) throw new Error(`there is no ${name}`);
	return found;
};
const shift = (name: string, change: Partial<Shift>): Shift => ({ thing: name, piece: null, dx: 0, dy: 0, wider: 0, higher: 0, ...change });
const told = (edits: readonly Edit[]): string[] =>
	edits.map((edit) => (edit.kind === 'set' ? `${edit.path.join('.')}: ${JSON.stringify(edit.was)} ${JSON.stringify(edit.value)}` : `${edit.kind} ${'path' in edit ? edit.path.join('.') : ''}`));

test('a thing moves with its slots, as numbers that are set one by one', () => {
	expect(told(editsOf(content, thing('dock'), shift('dock', { dx: 4 })))).toEqual(['symbols.dock.at.0: 20 24', 'symbols.dock.slots.0.at.0: 30 34']);
});

test('parts go along, and by themselves', () => {
	expect(told(editsOf(content, thing('engine'), shift('engine', { dy: -2 })))).toEqual(['symbols.engine.at.1: 100 98', 'symbols.engine.parts.0.at.1: 150 148']);
	expect(told(editsOf(content, thing('engine'), shift('engine', { piece: 'part:0', dx: 1 })))).toEqual(['symbols.engine.parts.0.at.0: 340 341']);
});

test('stops on a card go where it goes; those beyond it are places of their own', () => {
	expect(told(editsOf(content, thing('agv'), shift('agv', { dx: 10 })))).toEqual([
		'symbols.agv.at.0: 600 610',
		'symbols.agv.track.stops.here.at.0: 620 630',
		'symbols.agv.track.stops.there.at.0: 700 710'
	]);
	expect(told(editsOf(content, thing('robot'), shift('robot', { dx: 10 })))).toEqual(['symbols.robot.at.0: 500 510']);
	expect(told(editsOf(content, thing('robot'), shift('robot', { piece: 'stop:home', dx: 2, dy: 3 })))).toEqual([
		'symbols.robot.track.stops.home.at: [70,76] [72,79]'
	]);
});

test('a size that is not written is added, one that is there is set', () => {
	const edits = editsOf(content, thing('robot'), shift('robot', { wider: 7 }));
	expect(edits).toEqual([{ kind: 'add', file: 'mimic.yaml', path: ['symbols', 'robot', 'size'], value: [170, 44] }]);
	expect(told(editsOf(content, thing('dock'), shift('dock', { higher: -4 })))).toEqual(['symbols.dock.size.1: 96 92']);
});

test('no noise of binary fractions comes into the file', () => {
	expect(told(editsOf(content, thing('robot'), shift('robot', { dx: 0.1 + 0.2 })))).toEqual(['symbols.robot.at.0: 500 500.3']);
});

test('what is dragged is drawn where it will be, all that goes along with it', () => {
	const moved = shiftedPicture(mimic, thing('dock'), shift('dock', { dx: 5, dy: 6, wider: 8 })).symbols[0];
	expect(moved?.box).toEqual({ x: 25, y: 106, width: 192, height: 96 });
	expect(moved?.slots[0]?.box).toEqual({ x: 35, y: 116, width: 77, height: 64 });
	const engine = shiftedPicture(mimic, thing('engine'), shift('engine', { piece: 'part:0', dx: 10 })).symbols[1];
	expect(engine?.box.x).toBe(300);
	expect(engine?.parts.map(({ marks }) => marks[0]?.[0])).toEqual([350, 389]);
	const robot = shiftedPicture(mimic, thing('robot'), shift('robot', { dx: 10 })).symbols[3];
	expect([robot?.box.x, ...(robot?.track?.stops.map(({ x }) => x) ?? [])]).toEqual([510, 70, 515]);
});

test('a part is taken hold of where its marks are', () => {
	expect(thing('engine').pieces[0]?.box).toEqual({ x: 332, y: 132, width: 55, height: 70 });
});

test('what cannot be read as a place is left out, and nothing breaks', () => {
	const broken: Json = { symbols: { one: { at: ['a', 2] }, two: { at: [1, 2], size: 4, slots: 'no', parts: [{}], track: { stops: { x: {} } } }, three: null } };
	expect(thingsOf(broken, null).map(({ name, pieces }) => [name, pieces.length])).toEqual([['two', 0]]);
	expect(thingsOf(undefined, null)).toEqual([]);
});

test('what is dragged rests on the grid, and at an edge that is near', () => {
	const box = { x: 10, y: 10, width: 50, height: 20 };
	expect(snapped(box, box, [], 3.2, 0.7)).toEqual({ dx: 4, dy: 0, guides: [] });
	const beside = { x: 103, y: 400, width: 30, height: 20 };
	expect(snapped(box, box, [beside], 41.5, 0)).toMatchObject({ dx: 43, guides: [{ axis: 'x', at: 103 }] }); // its right edge at the left one
	expect(snapped(box, box, [beside], 36, 0).guides).toEqual([]);
	expect(resized(box, [], -90, 3.4, 12)).toMatchObject({ dx: -38, dy: 4 });
});

test('a copy has all its places beside those of the first', () => {
	const dock = valueAt(content, ['symbols', 'dock']) ?? null;
	expect(copyBeside(dock, 16)).toEqual({ at: [36, 116], size: [184, 96], slots: [{ at: [46, 126], title: 'Tool', holds: { tool: true } }] });
	expect(freeName('dock', ['dock', 'dock_2'])).toBe('dock_3');
	expect(freeName('dock_2', ['dock', 'dock_2'])).toBe('dock_3');
	expect(freeName('tank', ['dock'])).toBe('tank');
});

test('something new lies on nothing', () => {
	const things = thingsOf(content, mimic);
	const [x, y] = freePlace(things, { width: 872, height: 346 }, [163, 44]);
	for (const { box } of things) expect(x >= box.x + box.width || box.x >= x + 163 || y >= box.y + box.height || box.y >= y + 44).toBe(true);
	expect(freePlace(things, { width: 50, height: 50 }, [163, 44])).toEqual([10, 10]);
});
