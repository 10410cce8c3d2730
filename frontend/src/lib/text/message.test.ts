import { describe, expect, test } from 'vitest';
import refusals from '#lib/text/en/front.json';
import messages from '#lib/text/en/messages.json';
import { sv } from '#lib/text/sv.ts';
import { alarm } from '#lib/testing/view.ts';
import { tell, wordsOf } from './message.ts';

const EN = { texts: { ...refusals, ...messages }, language: 'en' };
const SV = { texts: sv.messages, language: 'sv' };

const waiting = (...titles: string[]) => ({
	id: 'wait.standstill',
	arguments: {
		waiting: {
			id: 'wait.operations',
			arguments: { operations: titles.map((title) => ({ id: 'quoted', arguments: { title } })), until: '' }
		}
	}
});

describe('a message', () => {
	test('is told in the language of the page', () => {
		expect(tell(waiting('Paint'), EN)).toBe('Nothing is started. “Paint” waits.');
		expect(tell(waiting('Paint', 'Dry'), EN)).toBe('Nothing is started. “Paint” and “Dry” wait.');
		expect(tell(waiting('Paint', 'Dry'), SV)).toBe('Inget startas. ”Paint” och ”Dry” väntar.');
	});

	test('counts what would be too long a list', () => {
		expect(tell(waiting('a', 'b', 'c', 'd', 'e'), SV)).toBe('Inget startas. ”a”, ”b”, ”c” och 2 till väntar.');
	});

	test('has the words of the model in the language that there is', () => {
		const said = (words: Record<string, string>) => tell({ id: 'as-it-was', arguments: { text: { words } } }, SV);
		expect(said({ en: 'Battery low', sv: 'Batteriet är lågt' })).toBe('Batteriet är lågt');
		expect(said({ en: 'Battery low' })).toBe('Battery low');
		expect(said({ fi: 'Akku vähissä' })).toBe('Akku vähissä');
	});
});

describe('an alarm', () => {
	test('of another program is told as it was written', () => {
		const unknown = { id: 'of-another-version', arguments: {} };
		const told = alarm({ text: 'It is hot', messages: { text: unknown, consequence: null, action: null, parts: [] } });
		expect(wordsOf(told, SV).text).toBe('It is hot');
	});

	test('of another version of the program, which says other things of it, is told as it was written', () => {
		const other = { id: 'silent.action', arguments: { device: 'Robot' } };
		const told = alarm({ text: 'It is hot', messages: { text: other, consequence: null, action: null, parts: [] } });
		expect(wordsOf(told, SV).text).toBe('It is hot');
	});

	test('of a record of before, which has but its texts, reads as it did', () => {
		const { messages: _, ...before } = alarm({ text: 'It is hot', parts: ['one'] });
		expect(wordsOf(before, SV)).toMatchObject({ text: 'It is hot', parts: ['one'] });
	});
});
