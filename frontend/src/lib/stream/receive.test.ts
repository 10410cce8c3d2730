import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Delta, StationView, Task } from '#lib/contract.ts';
import { task, view } from '#lib/testing/view.ts';
import { NOTHING, apply, receive, type Stream } from './receive.ts';

const started = (over: Partial<StationView> = {}): Stream =>
	receive(NOTHING, { kind: 'snapshot', sequence: 7, age: null, view: view(over) });
const delta = (sequence: number, changed: Delta['changed'] = {}, removed: Delta['removed'] = {}): Delta => ({
	kind: 'delta',
	sequence,
	changed,
	removed
});

/** What a server does: the delta that leads from one document to the other. */
function difference(before: StationView, after: StationView, sequence: number): Delta {
	const tasks = Object.fromEntries(Object.entries(after.tasks).filter(([key, value]) => before.tasks[key] !== value));
	const removed = Object.keys(before.tasks).filter((key) => !Object.hasOwn(after.tasks, key));
	return delta(sequence, { tick: after.tick, tasks }, { tasks: removed });
}

const documents = fc
	.record({
		tick: fc.nat(),
		tasks: fc.dictionary(fc.string(), fc.integer().map(task), { maxKeys: 5, noNullPrototype: true })
	})
	.map((over) => view(over));

describe('a delta', () => {
	test('leads from any document to any other', () => {
		fc.assert(
			fc.property(documents, documents, (before, after) => {
				expect(apply(before, difference(before, after, 1))).toEqual(after);
			})
		);
	});

	test('leaves the document it is applied to as it was', () => {
		const before = view({ tasks: { '1': task(1) } });
		const copy = structuredClone(before);
		apply(before, delta(1, { tick: 5, tasks: { '2': task(2) } }, { tasks: ['1'] }));
		expect(before).toEqual(copy);
	});

	test('merges into maps and replaces what is no map', () => {
		const plan = { ...view().plan, reason: 'robot was moved' };
		const stream = receive(started({ tasks: { '1': task(1) } }), delta(8, { plan, tasks: { '2': task(2) } }));
		expect(stream.view?.plan.reason).toBe('robot was moved');
		expect(Object.keys(stream.view?.tasks ?? {})).toEqual(['1', '2']);
	});

	test('keeps the identity of what did not change', () => {
		const before = started({ tasks: { '1': task(1) } });
		const after = receive(before, delta(8, { tick: 3 }));
		expect(after.view?.tasks).toBe(before.view?.tasks);
	});

	test('says nothing before the first snapshot', () => {
		expect(receive(NOTHING, delta(8, { tick: 3 }))).toBe(NOTHING);
	});
});

describe('a gap', () => {
	test('is any number that does not follow', () => {
		fc.assert(
			fc.property(fc.integer(), (sequence) => {
				const after = receive(started(), delta(sequence, { tick: 99 }));
				expect(after.gap).toBe(sequence !== 8);
				expect(after.view?.tick).toBe(sequence === 8 ? 99 : 0);
			})
		);
	});

	test('lets nothing in until a snapshot heals it', () => {
		const broken = receive(started(), delta(9, { tick: 9 }));
		const still = receive(broken, delta(8, { tick: 8 }));
		expect(still).toMatchObject({ gap: true, view: { tick: 0 } });
		const healed = receive(still, { kind: 'snapshot', sequence: 20, age: null, view: view({ tick: 20 }) });
		expect(receive(healed, delta(21, { tick: 21 }))).toMatchObject({ gap: false, view: { tick: 21 } });
	});

	test('hidden behind a message about the link is noticed', () => {
		const lost = { kind: 'link', controller: 'lost' } as const;
		expect(receive(started(), { ...lost, sequence: 7 })).toMatchObject({ gap: false, sequence: 7 });
		expect(receive(started(), { ...lost, sequence: 8 })).toMatchObject({ gap: false, sequence: 8 });
		expect(receive(started(), { ...lost, sequence: 9 })).toMatchObject({ gap: true, controller: 'lost' });
	});
});

test('a delta does not bring a lost controller back; the server says when it is heard', () => {
	const lost = receive(started(), { kind: 'link', sequence: 8, controller: 'lost' });
	expect(receive(lost, delta(9)).controller).toBe('lost');
	expect(receive(lost, { kind: 'link', sequence: 9, controller: 'heard' }).controller).toBe('heard');
});

test('what the server complains of is kept until the next snapshot', () => {
	const stream = receive(started(), { kind: 'error', detail: 'not JSON' });
	expect(stream.trouble).toBe('not JSON');
	expect(receive(stream, { kind: 'snapshot', sequence: 1, age: null, view: view() }).trouble).toBeNull();
});

test('a task named like a property of all objects is a task', () => {
	const entries = JSON.parse('{"__proto__": null, "constructor": null}') as Record<string, Task>;
	const after = apply(view(), { changed: { tasks: entries }, removed: { tasks: ['toString'] } });
	expect(Object.keys(after.tasks)).toEqual(['__proto__', 'constructor']);
});
