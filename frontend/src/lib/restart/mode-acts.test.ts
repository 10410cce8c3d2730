import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Refusal } from '#lib/rest/refusal.ts';
import { actsTo, doAll, type Aim, type ModeAct } from './mode-acts.ts';

const mode = fc.constantFrom('automatic', 'paused', 'hold', 'restart');
const production = fc.constantFrom('waiting', 'started');
const aim = fc.constantFrom<Aim>('control', 'enter', 'leave', 'start', 'go', 'production');

/** The station after an act, or null where the server would refuse it. */
function after(at: { mode: string; production: string; mine: boolean }, act: ModeAct): typeof at | null {
	if (act === 'control') return at.mine ? null : { ...at, mine: true };
	if (!at.mine) return null;
	if (act === 'enter') return at.mode === 'restart' ? null : { ...at, mode: 'restart' };
	if (act === 'leave') return at.mode === 'restart' ? { ...at, mode: 'paused' } : null;
	if (act === 'start') return at.production === 'waiting' ? { ...at, production: 'started' } : null;
	return at.mode === 'restart' ? null : { ...at, mode: 'automatic' };
}

test('whatever is wanted, none of the acts is refused, and what was wanted is so afterwards', () => {
	fc.assert(
		fc.property(mode, production, fc.boolean(), aim, (mode, production, mine, aim) => {
			let at = { mode, production, mine } as { mode: string; production: string; mine: boolean };
			for (const act of actsTo(aim, { mode, production } as never, mine)) {
				const then = after(at, act);
				expect(then, `${act} to ${aim}`).not.toBeNull();
				at = then ?? at;
			}
			if (aim === 'control') expect(at.mine).toBe(true);
			if (aim === 'enter') expect(at.mode).toBe('restart');
			if (aim === 'leave') expect(at.mode).not.toBe('restart');
			if (aim === 'start') expect(at.production).toBe('started');
			if (aim === 'production') expect([at.mode, at.production]).toEqual(['automatic', 'started']);
		})
	);
});

test('control is taken only for something that is done with it', () => {
	expect(actsTo('production', { mode: 'automatic', production: 'started' }, false)).toEqual([]);
	expect(actsTo('enter', { mode: 'restart', production: 'started' }, false)).toEqual([]);
	expect(actsTo('production', { mode: 'restart', production: 'started' }, false)).toEqual(['control', 'leave', 'go']);
});

test('the first that is refused ends it: nothing more is sent, and what was done is told', async () => {
	const refusal = { title: 'Not now' } as Refusal;
	const sent: ModeAct[] = [];
	const done: ModeAct[] = [];
	const answers = (act: ModeAct) => () => {
		sent.push(act);
		return Promise.resolve(act === 'leave' ? refusal : null);
	};
	const commands = { control: answers('control'), enter: answers('enter'), leave: answers('leave'), start: answers('start'), go: answers('go') };
	expect(await doAll(['control', 'leave', 'go'], (act) => done.push(act), commands)).toBe(refusal);
	expect(sent).toEqual(['control', 'leave']);
	expect(done).toEqual(['control']);
});
