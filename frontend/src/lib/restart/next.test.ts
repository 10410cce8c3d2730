import { describe, expect, test } from 'vitest';
import type { AdviceAnswer, StationView, WayOffer } from '#lib/contract.ts';
import { offer, preview } from '#lib/testing/offer.ts';
import { alarm, view } from '#lib/testing/view.ts';
import { nextAct, stepOf, type Next, type Standing } from './next.ts';

const QUESTION = { variable: 'b', believed: 'placed', so: { id: 'as-it-was', arguments: { text: 'b is placed' } }, possible: ['empty'], because: [], because_messages: [] };
const UNDECIDED = { 'robot.go': { value: true, reacts: [], reacts_messages: [], quiet: [false], unsafe: [] } };
const ERRAND = { kind: 'reset', title: '', title_message: { id: 'as-it-was', arguments: { text: '' } }, by: 'Eva', why: '', since: 0, ends: null, ends_message: null, into_safe: true, ability: null } as const;
const HANDS = offer({ kind: 'physical', online: ['robot'] });
const TAKE = offer({ kind: 'restart', errand: preview('back') });
const WAY_BACK = { violated: [], threatened: [], differences: [], awaits: [], ticks: null, steps: [], breaks: [], reason: '', reason_message: { id: 'as-it-was', arguments: { text: '' } } };

function advice(...offers: WayOffer[]): AdviceAnswer {
	const if_checked = offers.filter((each) => each.only_if_checked);
	return { revision: 0, offers: offers.filter((each) => !each.only_if_checked), if_checked, reasons: null, complete: true, seconds: 0 };
}

function next(over: Partial<StationView>, answer: AdviceAnswer | null = null, who: Partial<Standing> = {}): Next {
	return nextAct(view(over), { live: true, acts: true, advice: answer, ...who });
}

describe('what a person does next', () => {
	test('is nothing while the station works by itself', () => expect(next({})).toBe('nothing'));

	test('waits for a live view and a role', () => {
		expect(next({ mode: 'hold' }, null, { live: false })).toBe('live');
		expect(next({ mode: 'hold' }, null, { acts: false })).toBe('viewer');
	});

	test('after a start: decide, answer, then start production', () => {
		const waiting = { production: 'waiting', unconfirmed: true } as const;
		expect(next({ ...waiting, undecided: UNDECIDED })).toBe('decide');
		expect(next({ ...waiting, questions: [QUESTION] })).toBe('answer');
		expect(next(waiting)).toBe('answer');
		expect(next({ production: 'waiting' })).toBe('start');
	});

	test('at work: confirm what came back, and into restart mode where there is no plan', () => {
		expect(next({ unconfirmed: true })).toBe('answer');
		expect(next({ way_back: WAY_BACK })).toBe('enter');
	});

	test('is never nothing while an alarm lasts, and what it reminds of is none', () => {
		const late = { late: alarm() };
		expect(next({ alarms: late })).toBe('looking');
		expect(next({ alarms: late }, advice(HANDS))).toBe('physical');
		expect(next({ alarms: late }, advice(TAKE))).toBe('enter');
		expect(next({ alarms: late }, advice(offer()))).toBe('look');
		expect(next({ alarms: { force: alarm({ priority: 'low' }) } })).toBe('nothing');
		expect(next({ alarms: { over: alarm({ ended: 995 }) } })).toBe('nothing');
	});

	test('held: into restart mode, unless the station can go on as it is', () => {
		expect(next({ mode: 'hold' })).toBe('looking');
		expect(next({ mode: 'hold' }, advice(offer()))).toBe('continue');
		expect(next({ mode: 'hold' }, advice(TAKE))).toBe('enter');
		expect(next({ mode: 'hold', way_back: WAY_BACK }, advice(offer()))).toBe('enter');
		expect(next({ mode: 'paused', questions: [QUESTION] })).toBe('enter');
	});

	test('in restart mode: answer, take what is offered, and leave when nothing is left to do', () => {
		const inside = { mode: 'restart' } as const;
		expect(next({ ...inside, questions: [QUESTION] }, advice(offer()))).toBe('answer');
		expect(next(inside, advice(TAKE, offer()))).toBe('take');
		expect(next(inside, advice(HANDS))).toBe('physical');
		expect(next(inside, advice())).toBe('stuck');
		expect(next(inside, advice(offer()))).toBe('leave');
		expect(next({ ...inside, errand: ERRAND }, advice(offer()))).toBe('errand');
	});

	test('is to look, where all that is left is said and not done', () => {
		const corrections = [{ name: 'b', now: 'placed', then: 'empty', so: { id: 'as-it-was', arguments: { text: 'b is empty' } }, by_hand: null }];
		expect(next({ mode: 'restart' }, advice(offer({ kind: 'correction', corrections })))).toBe('check');
		const tight = offer({ kind: 'correction', corrections, claims: ['tighten'], only_if_checked: true });
		expect(next({ mode: 'restart' }, advice(tight))).toBe('check');
		expect(next({ mode: 'paused' }, advice(tight))).toBe('enter');
		expect(next({ mode: 'restart' }, advice(TAKE, tight))).toBe('take');
	});

	test('is never told from ways back for another state', () => {
		expect(next({ mode: 'restart', revision: 1 }, advice(offer()))).toBe('looking');
	});
});

describe('the step in which it is done', () => {
	test('is none while the station works by itself', () => expect(stepOf('nothing', view({}))).toBeNull());

	test('has restart mode within it where it needs it', () => {
		expect(stepOf('enter', view({ questions: [QUESTION] }))).toBe('state');
		expect(stepOf('enter', view({ way_back: WAY_BACK }))).toBe('ways');
		expect(stepOf('enter', view({}))).toBe('ways');
	});

	test('leads on with what is done', () => {
		expect((['look', 'answer', 'take', 'leave'] as const).map((next) => stepOf(next, view({})))).toEqual(['understand', 'state', 'ways', 'on']);
	});
});
