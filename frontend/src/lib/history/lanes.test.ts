import { describe, expect, test } from 'vitest';
import type { Mark, TimeLine } from '#lib/contract.ts';
import { alarmsOf, gathered, lanesOf, nearest, placed, runsOf, type Bar, type Spot } from './lanes.ts';
import { namesOf } from './names.ts';

const names = namesOf(null);
const window = { from: 100, to: 200 };

function mark(number: number, time: number, kind: string, content: Mark['content']): Mark {
	return { number, time, kind, content };
}

function line(marks: Mark[], rest: Partial<TimeLine> = {}): TimeLine {
	const first = { number: 1, time: 0 };
	const last = { number: 99, time: 190 };
	return { first, last, begin: 10, end: 99, running: [], active: [], mode: 'paused', alarms: [], marks, whole: true, bins: [], ...rest };
}

describe('what ran', () => {
	test('lasts from its start to its end', () => {
		const marks = [
			mark(11, 110, 'ticked', { started: ['robot.move'] }),
			mark(12, 130, 'ticked', { ended: ['robot.move'], started: ['robot.wait'] }),
			mark(13, 150, 'ticked', { ended: ['tool.run'] })
		];
		const runs = runsOf(line(marks, { running: ['tool.run'] }), window, Infinity);
		expect(runs.get('robot.move')).toEqual([{ from: 110, to: 130, number: 11, label: 'robot.move', open: false }]);
		expect(runs.get('tool.run')).toMatchObject([{ from: 100, to: 150, number: null, open: false }]);
		expect(runs.get('robot.wait')).toMatchObject([{ from: 130, to: 200, open: true }]);
	});

	test('is not known to go on where nobody would write its end', () => {
		const runs = runsOf(line([], { running: ['tool.run'] }), window, 150);
		expect(runs.get('tool.run')).toMatchObject([{ from: 100, to: 150, open: true }]);
	});
});

test('each thing has its lane', () => {
	const lanes = lanesOf(
		line([
			mark(11, 110, 'mode-changed', { mode: 'automatic', by: 'Eva' }),
			mark(12, 120, 'answered', { plan: { status: 'followed', reason: '', replaced: true } }),
			mark(13, 130, 'ticked', { started: ['robot.move'], completed: ['bring'], activated: ['place'] }),
			mark(14, 140, 'alarm', { event: 'came', text: 'The robot is silent', priority: 'high' }),
			mark(15, 150, 'by-hand', { changed: { bolts: ['empty', 'placed'] } })
		], { active: ['bring'] }),
		[],
		{ window, until: Infinity, resources: ['robot', 'tool'], names }
	);
	const lane = (id: string) => lanes.find((each) => each.id === id);
	expect(lane('mode')?.bars.map(({ label, from, to }) => [label, from, to])).toEqual([
		['Paused', 100, 110],
		['Automatic', 110, 200]
	]);
	expect(lane('plan')?.spots.map((spot) => spot.label)).toEqual(['Plan replaced']);
	expect(lane('of robot')?.bars.map((bar) => bar.number)).toEqual([13]);
	expect(lane('of tool')?.bars).toEqual([]);
	expect(lane('people')?.spots.map(({ label, alarm }) => [label, alarm])).toEqual([
		['Moved by hand, or by nothing the model knows: Bolts: empty → placed', undefined],
		['Alarm came: The robot is silent', 'high']
	]);
	expect(lane('operations')?.bars.map(({ label, from, to, open }) => [label, from, to, open])).toEqual([
		['bring', 100, 130, false],
		['place', 130, 200, true]
	]);
});

test('what was called off as it did not end in time has failed, and what a person stopped has not', () => {
	const marks = [
		mark(11, 110, 'ticked', { started: ['tool.run', 'robot.move'] }),
		mark(12, 130, 'ticked', { called_off: ['tool.run'] }),
		mark(13, 140, 'called-off', { called_off: ['robot.move'] })
	];
	const runs = runsOf(line(marks), window, Infinity);
	expect(runs.get('tool.run')).toMatchObject([{ to: 130, failed: true }]);
	expect(runs.get('robot.move')?.[0]?.failed).toBeUndefined();
});

test('what ran when its device did not go on is told from the others, with the cause', () => {
	const alarm = { event: 'came', kind: 'overdue', text: 'The tool has stalled. It turns', priority: 'high', resources: ['tool'], parts: [] };
	const marks = [
		mark(11, 110, 'ticked', { started: ['tool.run', 'robot.move'] }),
		mark(12, 130, 'alarm', alarm),
		mark(13, 150, 'ticked', { ended: ['tool.run'] }),
		mark(14, 160, 'ticked', { started: ['tool.run'] })
	];
	const lanes = lanesOf(line(marks), [], { window, until: Infinity, resources: ['robot', 'tool'], names: { ...names, resourceOf: (id) => id.split('.')[0] ?? '' } });
	const bars = (id: string) => lanes.find((each) => each.id === id)?.bars.map(({ failed, cause }) => [failed, cause]);
	expect(bars('of tool')).toEqual([[true, 'The tool has stalled'], [undefined, undefined]]);
	expect(bars('of robot')).toEqual([[undefined, undefined]]);
});

test('an alarm that comes again is as much in sight as one that came', () => {
	const alarm = { event: 'came again', kind: 'overdue', subject: 'tool.run', text: 'The tool does not start. It rests', priority: 'medium', resources: ['tool'], parts: [] };
	const marks = [
		mark(11, 110, 'ticked', { started: ['tool.run'] }),
		mark(12, 120, 'alarm', alarm),
		mark(13, 130, 'alarm', { ...alarm, event: 'became more urgent', priority: 'high' }),
		mark(14, 140, 'alarm', { ...alarm, event: 'acknowledged' }),
		mark(15, 150, 'alarm', { ...alarm, event: 'returned' })
	];
	expect(alarmsOf(line(marks), names).map(({ alarm: priority }) => priority)).toEqual(['medium', 'high', undefined, undefined]);
	const lanes = lanesOf(line(marks), [], { window, until: Infinity, resources: ['tool'], names: { ...names, resourceOf: () => 'tool' } });
	expect(lanes.find(({ id }) => id === 'of tool')?.bars).toMatchObject([{ failed: true, cause: 'The tool does not start', priority: 'high' }]);
});

test('of two that run on one device each is told by its own alarm', () => {
	const alarm = (subject: string, text: string) => ({ event: 'came', kind: 'overdue', subject, text, priority: 'medium', resources: ['tool'], parts: [] });
	const marks = [
		mark(11, 110, 'ticked', { started: ['tool.float'] }),
		mark(12, 120, 'ticked', { started: ['tool.run'] }),
		mark(13, 130, 'alarm', alarm('tool.run', 'The tool does not start')),
		mark(14, 131, 'alarm', alarm('tool.float', 'The tool does not float'))
	];
	const lanes = lanesOf(line(marks), [], { window, until: Infinity, resources: ['tool'], names: { ...names, resourceOf: () => 'tool' } });
	expect(lanes.find(({ id }) => id === 'of tool')?.bars.map(({ label, cause }) => [label, cause])).toEqual([
		['tool.float', 'The tool does not float'],
		['tool.run', 'The tool does not start']
	]);
});

test('what only does something at its start is over with it', () => {
	const marks = [
		mark(11, 110, 'ticked', { started: ['engine.next', 'tool.run'], at_once: ['engine.next'] }),
		mark(12, 180, 'ticked', { started: ['engine.next'], at_once: ['engine.next'] })
	];
	const runs = runsOf(line(marks), window, Infinity);
	expect(runs.get('engine.next')).toMatchObject([
		{ from: 110, to: 110, open: false },
		{ from: 180, to: 180, open: false }
	]);
	expect(runs.get('tool.run')).toMatchObject([{ from: 110, to: 200, open: true }]);
});

test('what goes with a mode is told beside it: nothing lies over the names of modes', () => {
	const marks = [mark(11, 110, 'errand-taken', { errand: { by: 'Eva', why: '' } }), mark(12, 120, 'called-off', { by: 'Eva' })];
	const lanes = lanesOf(line(marks), [], { window, until: Infinity, resources: [], names });
	const counts = Object.fromEntries(lanes.map(({ id, spots }) => [id, spots.length]));
	expect(counts).toEqual({ mode: 0, operations: 0, plan: 1, people: 1 });
});

test('what did not go on is told from the others also where its alarm came before the window', () => {
	const alarm = { event: 'came', kind: 'overdue', text: 'The tool has stalled. It turns', priority: 'high', resources: ['tool'], parts: [] };
	const marks = [mark(13, 150, 'ticked', { ended: ['tool.run'] }), mark(14, 160, 'ticked', { started: ['tool.run'] })];
	const past = line(marks, { running: ['tool.run'], alarms: [mark(4, 40, 'alarm', alarm)] });
	const lanes = lanesOf(past, [], { window, until: Infinity, resources: ['tool'], names: { ...names, resourceOf: (id) => id.split('.')[0] ?? '' } });
	const bars = lanes.find(({ id }) => id === 'of tool')?.bars;
	expect(bars?.map(({ failed, cause, priority }) => [failed, cause, priority])).toEqual([
		[true, 'The tool has stalled', 'high'],
		[undefined, undefined, undefined]
	]);
});

test('bars that last at the same time stand one below the other, in three rows at most', () => {
	const bar = (from: number, to: number): Bar => ({ from, to, label: '', number: null, open: false });
	const { rows, all } = placed([bar(0, 10), bar(2, 12), bar(3, 13), bar(4, 14), bar(12, 20)]);
	expect(rows).toBe(3);
	expect(all.map(({ row, crowded }) => `${row}${crowded ? ' crowded' : ''}`)).toEqual(['0', '1', '2', '2 crowded', '0']);
});

test('what has stopped or goes on has its words rather than what has ended', () => {
	const bar = (from: number, rest: Partial<Bar> = {}): Bar => ({ from, to: from, label: '', number: null, open: false, ...rest });
	const { rows, all } = placed([bar(0), bar(1), bar(2), bar(3, { open: true }), bar(4, { failed: true }), bar(5)], 10);
	expect(rows).toBe(3);
	expect(all.map(({ row, crowded }) => `${row}${crowded ? ' crowded' : ''}`)).toEqual(['0', '1 crowded', '2 crowded', '2', '1', '2 crowded']);
});

test('what only begins has the room of its words, and one that has none takes it from no other', () => {
	const bar = (at: number): Bar => ({ from: at, to: at, label: '', number: null, open: false });
	const { all } = placed([bar(0), bar(1), bar(2), bar(3), bar(10), bar(11)], 10);
	expect(all.map(({ row, crowded }) => `${row}${crowded ? ' crowded' : ''}`)).toEqual(['0', '1', '2', '2 crowded', '0', '1']);
});

test('marks that would cover one another are one, and what is pressed is the nearest', () => {
	const spots = [110, 111, 160].map((time): Spot => ({ time, label: '', number: time, act: null, refused: false }));
	expect(gathered(spots, window, 0.05).map((group) => group.length)).toEqual([2, 1]);
	const lane = { id: 'a', title: '', bars: [], spots };
	expect(nearest(lane, 158, 5)?.number).toBe(160);
	expect(nearest(lane, 140, 5)).toBeNull();
});
