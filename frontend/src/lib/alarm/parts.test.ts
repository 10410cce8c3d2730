import { expect, test } from 'vitest';
import { alarm } from '#lib/testing/view.ts';
import { partsOf } from './parts.ts';

const TELLS: Readonly<Record<string, readonly string[]>> = { '/robot/state': ['pose', 'moving'] };
const about = (topic: string): readonly string[] => TELLS[topic] ?? [];
const silence = (topic: string): { id: string; arguments: Record<string, string> } => ({
	id: 'silent.no-message',
	arguments: { topic, why: '' }
});

test('a silent topic is told by what it tells, with its name beside it', () => {
	const plain = alarm();
	const parts = ['No more messages on /robot/state', 'No more messages on /lamp', 'Left out: Paint'];
	const messages = [silence('/robot/state'), silence('/lamp'), { id: 'as-it-was', arguments: { text: 'Left out: Paint' } }];
	const told = partsOf({ parts, messages: { ...plain.messages, parts: messages } }, about);
	expect(told).toEqual([
		{ text: 'No more messages: pose and moving', topic: '/robot/state' },
		{ text: 'No more messages', topic: '/lamp' },
		{ text: 'Left out: Paint', topic: null }
	]);
});

test('why a topic is silent stands behind it, and what reads the same is told once', () => {
	const plain = alarm();
	const why = { id: 'silent.why', arguments: { why: 'nobody publishes it' } };
	const messages = [silence('/lamp'), silence('/lamp'), { id: 'silent.no-message-yet', arguments: { topic: '/lamp', why } }];
	const told = partsOf({ parts: ['', '', ''], messages: { ...plain.messages, parts: messages } }, about);
	expect(told.map(({ text }) => text)).toEqual(['No more messages', 'No message yet (nobody publishes it)']);
});
