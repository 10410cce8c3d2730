import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Edit, OperationLink } from '#lib/contract.ts';
import type { Json } from '#lib/model/content.ts';
import { drawn, erased, grouped, OPERATIONS as file, TOGETHER } from './arrows.ts';

const link = (before: string, after: string, ...reasons: [OperationLink['reasons'][number]['kind'], string][]): OperationLink => ({
	before,
	after,
	again: false,
	reasons: reasons.map(([kind, name]) => ({ kind, name, condition: null }))
});

test('an arrow is a new sequence, under a name that is not taken', () => {
	const content = { place: { goal: 'placed' }, place_then_tighten: { sequence: ['x', 'y'] } };
	const edit = { kind: 'add', file, before: null, after: null };
	expect(drawn({}, 'place(one)', 'tighten(one)')).toEqual([{ ...edit, path: ['place_then_tighten'], value: { sequence: ['place(one)', 'tighten(one)'] } }]);
	expect(drawn(content, 'place', 'tighten')).toEqual([{ ...edit, path: ['place_then_tighten_2'], value: { sequence: ['place', 'tighten'] } }]);
});

test('a sequence that ends or begins with one of the two grows', () => {
	const content = { work: { title: 'Work', sequence: ['a', 'b'] } };
	const grown = (value: string[]): unknown => [{ kind: 'set', file, path: ['work', 'sequence'], was: ['a', 'b'], value }];
	expect(drawn(content, 'b', 'c')).toEqual(grown(['a', 'b', 'c']));
	expect(drawn(content, 'z', 'a')).toEqual(grown(['z', 'a', 'b']));
	// One that is written for several, or has something else within, is left as it is.
	const others: Json[] = [{ for: { p: 'pair' }, sequence: ['a', 'b'] }, { sequence: ['a', { parallel: ['b'] }] }, { parallel: ['a', 'b'] }];
	for (const other of others)
		expect(drawn({ work: other }, 'b', 'c')[0]).toMatchObject({ kind: 'add', path: ['b_then_c'] });
});

test('an arrow that is taken out parts its sequence, and nothing else is touched', () => {
	const steps = ['a', 'b', 'c', 'd'];
	const of = (before: string, after: string): OperationLink => link(before, after, ['sequence', 'work']);
	const set = (value: string[]): unknown => ({ kind: 'set', file, path: ['work', 'sequence'], was: steps, value });
	const content = { work: { sequence: steps } };
	expect(erased(content, of('b', 'c'))).toEqual([
		set(['a', 'b']),
		{ kind: 'add', file, path: ['work_2'], value: { sequence: ['c', 'd'] }, before: null, after: null }
	]);
	expect(erased(content, of('a', 'b'))).toEqual([set(['b', 'c', 'd'])]);
	expect(erased(content, of('c', 'd'))).toEqual([set(['a', 'b', 'c'])]);
	const two = { work: { sequence: ['a', 'b'] } };
	expect(erased(two, of('a', 'b'))).toEqual([{ kind: 'remove', file, path: ['work'], was: two.work }]);
});

test('what something else says too is not taken out here', () => {
	const content = { work: { sequence: ['a', 'b'] }, several: { for: { p: 'pair' }, sequence: 'a(p)' } };
	expect(erased(content, link('a', 'b', ['sequence', 'work'], ['condition', '']))).toBeNull();
	expect(erased(content, link('a', 'b', ['work_master', 'engine']))).toBeNull();
	expect(erased(content, link('a(1)', 'a(2)', ['sequence', 'several']))).toBeNull();
	expect(erased(undefined, link('a', 'b', ['sequence', 'work']))).toBeNull();
});

/** What the file has after the edits. */
function after(content: { [name: string]: Json }, edits: readonly Edit[]): Json {
	const changed = structuredClone(content);
	for (const edit of edits) {
		if (edit.kind === 'add') changed[String(edit.path[0])] = edit.value as Json;
		else if (edit.kind === 'set') {
			const entry = changed[String(edit.path[0])] as { [key: string]: Json };
			expect(entry[String(edit.path[1])]).toEqual(edit.was);
			entry[String(edit.path[1])] = edit.value as Json;
		}
	}
	return changed;
}

test('those that follow on one another in a list are put beside one another there, in the order in which they were picked', () => {
	const content: { [name: string]: Json } = { work: { title: 'Work', sequence: ['a', 'b', 'c', { parallel: ['x', 'y'] }] }, a: { goal: 'done' } };
	expect(after(content, grouped(content, 'alternative', ['c', 'b']))).toEqual({
		...content,
		work: { title: 'Work', sequence: ['a', { alternative: ['c', 'b'] }, { parallel: ['x', 'y'] }] }
	});
	// Those that are apart, or elsewhere, are a group of their own.
	expect(after(content, grouped(content, 'arbitrary', ['a', 'c']))).toEqual({ ...content, a_and_c: { arbitrary: ['a', 'c'] } });
	expect(after(content, grouped(content, 'parallel', ['z(one)', 'z(two)']))).toEqual({ ...content, z_with_z: { parallel: ['z(one)', 'z(two)'] } });
	const each: { [name: string]: Json } = { work: { for: { p: 'pair' }, sequence: ['a', 'b'] } };
	expect(after(each, grouped(each, 'parallel', ['a', 'b']))).toEqual({ ...each, a_with_b: { parallel: ['a', 'b'] } });
});

test('several are put in order as one arrow after another would', () => {
	const content: { [name: string]: Json } = { work: { sequence: ['a', 'b'] } };
	expect(after(content, grouped(content, 'sequence', ['b', 'c', 'd']))).toEqual({ work: { sequence: ['a', 'b', 'c', 'd'] } });
	expect(after(content, grouped(content, 'sequence', ['y', 'z', 'a']))).toEqual({ work: { sequence: ['y', 'z', 'a', 'b'] } });
	expect(after(content, grouped(content, 'sequence', ['c', 'd', 'e']))).toEqual({ ...content, c_then_d: { sequence: ['c', 'd', 'e'] } });
});

test('whatever is put together, nothing that is written is lost, and all that is picked stands together once', () => {
	const names = ['a', 'b', 'c', 'd', 'e'];
	const picks = fc.shuffledSubarray(names, { minLength: 2 });
	fc.assert(
		fc.property(fc.shuffledSubarray(names), picks, fc.constantFrom(...TOGETHER), (steps, picked, how) => {
			const content: { [name: string]: Json } = { work: { title: 'Work', sequence: steps }, other: { parallel: ['a', 'b'] } };
			const done = after(content, grouped(content, how, picked)) as typeof content;
			expect(done['other']).toEqual(content['other']);
			const flat = (part: Json): string[] => (typeof part === 'string' ? [part] : Array.isArray(part) ? part.flatMap(flat) : Object.values(part as object).flatMap(flat));
			const work = flat((done['work'] as { sequence: Json }).sequence);
			expect(new Set(work).size).toBe(work.length);
			expect(steps.every((step) => work.includes(step))).toBe(true);
			if (how !== 'sequence') expect(JSON.stringify(done)).toContain(JSON.stringify({ [how]: picked }));
			else expect(JSON.stringify(done)).toContain(JSON.stringify(picked).slice(1, -1));
		})
	);
});
