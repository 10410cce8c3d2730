import { describe, expect, test } from 'vitest';
import type { Revisions, StationView, Transfer, Workshop } from '#lib/contract.ts';
import { differing, fateOf, isStanding, isUnrun, needsOf, onlyPauses, runningOf, savedAs, type Known } from './needs.ts';

const STATION = { name: 'cell', title: 'Cell', titles: {}, description: '', transport: 'dds', emulated: true, deployment_approval: 'single' } as const;
const VIEW: Known['view'] = { mode: 'paused', production: 'started', errand: null, analysis: null, station: STATION };
const UNMET: StationView['analysis'] = {
	pending: null,
	pending_message: null,
	supervised: false,
	reachable_states: null,
	supervised_states: null,
	supervised_at_most: null,
	guarded: null,
	guards: null,
	lifted: null,
	findings: []
};
const WORKSHOP: Workshop = {
	number: 7,
	files: { 'station.yaml': { digest: 'a', state: 'changed' }, 'x.yaml': { digest: 'b', state: 'same' } },
	changes: 1,
	last: null,
	planned: null,
	comment: 0,
	check: {
		number: 7,
		state: 'done',
		doing: '',
		doing_message: null,
		looked: [],
		findings: [],
		summary: null,
		analysis: { ...UNMET, supervised: true }
	}
};
const REVISIONS: Revisions = {
	revisions: [{ id: 'a'.repeat(40), name: 'New', message: '', by: 'Erik', time: 0, running: false, draft: true, approved_by: [], changes_requested_by: [] }],
	saved: true,
	running: false
};
const TRANSFER: Transfer = { legal: true, changes: [], violated: [], under_way: [], ways: [], obstacle: null, obstacle_message: null };
const KNOWN: Known = { view: VIEW, workshop: WORKSHOP, revisions: REVISIONS, transfer: TRANSFER, mine: true };
const missing = (change: Partial<Known>): string[] =>
	needsOf({ ...KNOWN, ...change })
		.filter(([, met]) => !met)
		.map(([need]) => need);

test('what still runs is told from the station as it is now, whatever was known of it before', () => {
	const ability = { resource: 'robot', title: 'Move', human: false, restart: false, moves: true, enabled: false, executing: true, finished: false };
	const abilities = {
		move: { ...ability, running_since: 5 },
		turn: { ...ability, title: 'Turn', running_since: null }
	};
	expect(runningOf({ abilities })).toEqual(['Move']);
	expect(runningOf({ abilities }, ['move', 'turn'])).toEqual(['Move']);
	expect(runningOf({ abilities }, ['turn'])).toEqual([]);
});

describe('a deployment needs', () => {
	test('nothing more where all is so', () => {
		expect(missing({})).toEqual([]);
	});

	test('a draft that is saved, another one than what runs, and checked as it is now', () => {
		expect(missing({ revisions: null })).toEqual(['saved']);
		expect(missing({ workshop: { ...WORKSHOP, files: {} } })).toEqual(['other']);
		expect(missing({ workshop: { ...WORKSHOP, number: 8 } })).toEqual(['checked']);
		const check = { ...WORKSHOP.check, analysis: UNMET };
		expect(missing({ workshop: { ...WORKSHOP, check } })).toEqual(['checked']);
	});

	test('the approval of somebody else where the model that runs asks for it, as long as nobody wants changes', () => {
		const view = { ...VIEW, station: { ...STATION, deployment_approval: 'dual' as const } };
		const said = (approved_by: string[], changes_requested_by: string[]): Revisions => ({
			...REVISIONS,
			revisions: REVISIONS.revisions.map((each) => ({ ...each, approved_by, changes_requested_by }))
		});
		expect(missing({ view })).toEqual(['approved']);
		expect(missing({ view, revisions: null })).toEqual(['saved', 'approved']);
		expect(missing({ view, revisions: said(['Maria'], []) })).toEqual([]);
		expect(missing({ view, revisions: said(['Maria'], ['Per']) })).toEqual(['approved']);
		expect(missing({ revisions: said([], ['Per']) })).toEqual([]);
	});

	test('a station that stands, in a state that is legal, and control', () => {
		expect(missing({ view: { ...VIEW, mode: 'automatic' } })).toEqual(['standing']);
		expect(missing({ mine: false })).toEqual(['control']);
		expect(missing({ transfer: null })).toEqual(['fits']);
		expect(missing({ transfer: { ...TRANSFER, legal: false } })).toEqual(['fits']);
	});

	test('neither where what is there cannot run at all', () => {
		const view: Known['view'] = { mode: 'automatic', production: 'preparing', errand: null, analysis: UNMET, station: STATION };
		expect(isUnrun(view)).toBe(true);
		expect(missing({ view, mine: false })).toEqual([]);
	});
});

test('a station stands where nothing is started by itself', () => {
	expect(isStanding(VIEW)).toBe(true);
	expect(isStanding({ ...VIEW, mode: 'automatic', production: 'waiting' })).toBe(true);
	expect(isStanding({ ...VIEW, mode: 'automatic' })).toBe(false);
	expect(isStanding({ ...VIEW, production: 'preparing' })).toBe(false);
});

test('files that differ, and the revision that the draft is', () => {
	expect(differing(WORKSHOP.files).map(([path]) => path)).toEqual(['station.yaml']);
	expect(savedAs(REVISIONS)?.name).toBe('New');
	expect(savedAs({ ...REVISIONS, revisions: [] })).toBeNull();
});

test('a variable is new, gone, or begins anew', () => {
	const of = (before: string | null, after: string | null, known: boolean): string =>
		fateOf({ name: 'x', before, after }, known);
	expect(of(null, 'a', false)).toBe('new');
	expect(of('a', null, true)).toBe('gone');
	expect(of('a', 'b', true)).toBe('anew');
	expect(of(null, 'b', true)).toBe('anew');
});

describe('to pause is enough', () => {
	const AT_WORK: Known['view'] = { ...VIEW, mode: 'automatic' };
	const enough = (change: Partial<Known>): boolean => {
		const known = { ...KNOWN, view: AT_WORK, ...change };
		return onlyPauses(needsOf(known), known.view, known.transfer);
	};

	test('where the station works by itself and all else is so', () => {
		expect(enough({})).toBe(true);
		expect(enough({ mine: false })).toBe(false);
		expect(enough({ view: VIEW })).toBe(false);
		expect(enough({ revisions: null })).toBe(false);
	});

	test('also where it has to wait for what would be another one, and for nothing else', () => {
		expect(enough({ transfer: { ...TRANSFER, legal: false, under_way: ['a'] } })).toBe(true);
		expect(enough({ transfer: { ...TRANSFER, legal: false, violated: ['x'], under_way: ['a'] } })).toBe(false);
		expect(enough({ transfer: { ...TRANSFER, legal: false } })).toBe(false);
		expect(enough({ transfer: null })).toBe(false);
	});
});
