import { describe, expect, test } from 'vitest';
import findings from '#lib/text/en/findings.json';
import refusals from '#lib/text/en/front.json';
import messages from '#lib/text/en/messages.json';
import { sv } from '#lib/text/sv.ts';
import { alarm } from '#lib/testing/view.ts';
import { cutOf, leading, tell, told, toldAll, toldHere, wordsOf } from './message.ts';
import { tellTitles } from '#lib/wording/titled.svelte.ts';

const EN = { texts: { ...refusals, ...messages, ...findings }, language: 'en' };
const SV = { texts: sv.messages, language: 'sv' };

const waiting = (...titles: string[]) => ({
	id: 'wait.standstill',
	arguments: {
		waiting: {
			id: 'wait.operations',
			arguments: { operations: titles.map((title) => ({ id: 'quoted', arguments: { title } })), what: '' }
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

	test('of which names were left out can be told as a whole', () => {
		const names = { id: 'found.more', arguments: { names: '`a`, `b`', count: 2, rest: ['`c`', '`d`'] } };
		const message = { id: 'found.too-many-states', arguments: { names } };
		const cut = cutOf(message, EN);
		expect(cut && [cut.before, cut.others, cut.after].join('')).toBe(tell(message, EN));
		expect(cut?.others).toBe(' and 2 more');
		expect(cut?.whole).toContain('of `a`, `b`, `c`, `d` it is not known');
		expect(cutOf(waiting('Paint'), EN)).toBeNull();
		expect(cutOf({ id: 'found.more', arguments: { names: '`a`', count: 2 } }, EN)).toBeNull();
	});

	test('has titles as they stand within a sentence, and as one begins with them', () => {
		const nutrunner = { words: { en: 'Nutrunner', sv: 'Mutterdragaren' } };
		const vehicle = { words: { en: 'AGV', sv: 'AGV:n' } };
		const dock = { words: { en: 'Tool dock', sv: 'Verktygsdockan' } };
		expect(tell({ id: 'silent.nothing', arguments: { resource: nutrunner } }, SV)).toBe('Inget hörs från mutterdragaren');
		expect(tell({ id: 'silent.nothing', arguments: { resource: vehicle } }, SV)).toBe('Inget hörs från AGV:n');
		expect(tell({ id: 'still.stalled', arguments: { resource: nutrunner, values: 'a' } }, SV)).toMatch(/^Mutterdragaren kommer inte vidare/);
		const several = { id: 'many-silent.some', arguments: { resources: [nutrunner, vehicle, dock], count: 3, of: 8 } };
		expect(tell(several, SV)).toBe('Mutterdragaren, AGV:n och verktygsdockan svarar inte (3 av 8 enheter)');
		expect(tell(several, EN)).toBe('Nutrunner, AGV and Tool dock are not responding (3 of 8 devices)');
	});

	test('says first what the model says of it', () => {
		const late = { id: 'late.finished', arguments: { seconds: 40 } };
		const resource = { words: { en: 'Nutrunner', sv: 'Mutterdragaren' } };
		const run = { id: 'late.run', arguments: { resource, ability: 'Run', late } };
		const words = { words: { en: 'the nutrunner does not lock', sv: 'mutterdragaren låser inte fast' } };
		const named = { id: 'overdue.text', arguments: { what: { id: 'late.named', arguments: { words, run } } } };
		expect(leading(tell(named, EN) ?? '')).toEqual(['The nutrunner does not lock', 'Nutrunner: “Run” has not finished within 40 s']);
		expect(leading(tell(named, SV) ?? '')).toEqual(['Mutterdragaren låser inte fast', 'Mutterdragaren: ”Run” har inte blivit klar inom 40 s']);
	});

	test('has the words of the model in the language that there is', () => {
		const said = (words: Record<string, string>) => tell({ id: 'as-it-was', arguments: { text: { words } } }, SV);
		expect(said({ en: 'Battery low', sv: 'Batteriet är lågt' })).toBe('Batteriet är lågt');
		expect(said({ en: 'Battery low' })).toBe('Battery low');
		expect(said({ fi: 'Akku vähissä' })).toBe('Akku vähissä');
	});
});

describe('what is found in a model', () => {
	const unknown = {
		id: 'wrong.unknown-variable',
		arguments: { name: 'robot.poes', hint: { id: 'hint.meant', arguments: { name: 'robot.pose' } } }
	};
	const why = { id: 'obstacle.unusable', arguments: { model: { id: 'obstacle.model.newer', arguments: {} }, place: 'operations.yaml:3:7', what: unknown } };

	test('is told with the names of the model as they are', () => {
		const read = { id: 'found.never-read', arguments: { names: '`a`, `b`', count: 2 } };
		expect(tell(read, SV)).toBe('inget läser `a`, `b`: ta bort dem, och ange deras fält under `ignore` om ett meddelande har dem');
		expect(tell({ ...read, arguments: { names: '`a`', count: 1 } }, EN)).toBe(
			'nothing reads `a`: leave it out, and list its field under `ignore` if a message has it'
		);
	});

	test('stands in what follows from it', () => {
		expect(tell(why, SV)).toBe('den nyare kan inte användas: operations.yaml:3:7: okänd variabel: `robot.poes`; menade du `robot.pose`?');
	});

	test('begins a sentence with a capital letter', () => {
		expect(tell({ id: 'refused.edit-refused.why', arguments: { why } }, SV)).toMatch(/^Den nyare kan inte .*\.$/);
		const name = { id: 'refused.edit-refused.why', arguments: { why: '`x` is there' } };
		expect(tell(name, EN)).toBe('`x` is there.');
	});

	test('is written as it is found where the page does not know it', () => {
		expect(told(null, 'it is odd', SV)).toBe('it is odd');
		expect(told({ id: 'found.of-another-version', arguments: {} }, 'it is odd', SV)).toBe('it is odd');
		expect(toldHere(null, SV)).toBeNull();
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

test('what reads the same is told once', () => {
	expect(toldAll(undefined, ['the pair is placed', 'the pair is placed', 'the robot is offline'], EN)).toEqual(['the pair is placed', 'the robot is offline']);
});

test('titles that were recorded in one text are said as they are called, one by one', () => {
	const none = { station: {}, resources: {}, abilities: {}, tasks: {}, specifications: {}, work_masters: {} };
	tellTitles({ ...none, operations: { a: { '': 'Place it', en: 'Put it in' }, b: { '': 'Tighten it', en: 'Make it tight' } } });
	const message = { id: 'plan.made', arguments: { operations: 'Place it, Tighten it, Unknown' } };
	expect(told(message, '', EN)).toBe('planned for Put it in, Make it tight, Unknown');
	tellTitles(null);
});
