import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { SHOWN, toasts } from './toasts.svelte.ts';

beforeEach(() => void vi.useFakeTimers());
afterEach(() => {
	toasts.hold(false);
	vi.runAllTimers();
	vi.useRealTimers();
});

const told = (): string[] => toasts.all.map(({ text }) => text);

test('what was done is told for some seconds', () => {
	toasts.tell('Shelved');
	vi.advanceTimersByTime(SHOWN - 1);
	expect(told()).toEqual(['Shelved']);
	vi.advanceTimersByTime(1);
	expect(told()).toEqual([]);
});

test('while somebody reads it stays, and then has its time once more', () => {
	toasts.tell('Shelved');
	vi.advanceTimersByTime(SHOWN - 1);
	toasts.hold(true);
	toasts.tell('Corrected');
	vi.advanceTimersByTime(10 * SHOWN);
	expect(told()).toEqual(['Shelved', 'Corrected']);
	toasts.hold(false);
	vi.advanceTimersByTime(SHOWN - 1);
	expect(told()).toEqual(['Shelved', 'Corrected']);
	vi.advanceTimersByTime(1);
	expect(told()).toEqual([]);
});

test('three at most are told, and what is said again is told once, as the newest', () => {
	for (const text of ['1', '2', '3', '4', '2']) toasts.tell(text);
	expect(told()).toEqual(['3', '4', '2']);
});

test('it can be put away before its time, by its number or by whoever told it', () => {
	const withdraw = toasts.tell('1');
	toasts.tell('2');
	withdraw();
	expect(told()).toEqual(['2']);
	for (const { id } of toasts.all) toasts.close(id);
	withdraw();
	expect(told()).toEqual([]);
});
