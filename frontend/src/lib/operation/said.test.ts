import { expect, test } from 'vitest';
import { operation } from '#lib/testing/view.ts';
import { say } from '#lib/text/text.svelte.ts';
import { eitherOf, saidOf } from './said.ts';

const TEXTS = say().operate.operations;

test('one that is worked on tells for how long, and not for how long it was active before', () => {
	const [active, work] = [{ active: true, active_since: 100 }, [{ began: 139, ended: null }]];
	expect(saidOf(operation({ ...active, work }), 'active', 144, 'automatic', TEXTS)).toBe('0:05');
	expect(saidOf(operation(active), 'active', 144, 'automatic', TEXTS)).toBe('0:44');
});

test('what is needed and is not its turn says why, and never that it is not needed', () => {
	const said = (how: 'none' | 'paused' | 'later'): string => saidOf(operation(), 'waits', 0, 'automatic', TEXTS, { how, job: '' });
	expect([said('none'), said('paused'), said('later')]).toEqual([TEXTS.noOrder, TEXTS.orderPaused, TEXTS.laterInOrder]);
	expect(saidOf(operation(), 'waits', 0, 'automatic', TEXTS)).toBe(TEXTS.soAlready);
});

test('of several that wait each for its own whatever may come first is told', () => {
	const placed = (pair: number): string => `waits until bolt pair ${pair} is placed`;
	expect(eitherOf([placed(1), placed(2), placed(3)], 'en')).toBe('waits until bolt pair 1, 2, or 3 is placed');
	expect(eitherOf([placed(1), placed(1)], 'en')).toBe(placed(1));
	expect(eitherOf([placed(1), 'waits for the robot'], 'en')).toBe(placed(1));
});
