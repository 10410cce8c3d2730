import { describe, expect, it } from 'vitest';
import type { Looked, PartAt } from './address.ts';
import { followed } from './following.ts';

const pipeline = (...ids: readonly string[]) => ({ resource: 'robot', stages: ids.map((id) => ({ id })) });
const looked = (part: PartAt | null): Looked => ({ pipeline: '/state', part, example: null });
const stage = (at: number): Looked => looked({ kind: 'stage', at });
const edge = (at: number): Looked => looked({ kind: 'edge', at });
const now = (what: Looked, before: readonly string[], after: readonly string[]): PartAt | null => followed(what, { '/state': pipeline(...before) }, { '/state': pipeline(...after) }).part;

describe('what is chosen when the pipelines have become others', () => {
	it('is the pipeline, where the stage is gone', () => {
		expect(now(stage(1), ['a', 'b', 'c'], ['a', 'c'])).toBeNull();
		expect(now(stage(1), ['a', 'b'], ['a'])).toBeNull();
	});

	it('is the same stage, wherever it stands', () => {
		expect(now(stage(1), ['a', 'b'], ['a', 'x', 'b'])).toEqual({ kind: 'stage', at: 2 });
		expect(now(stage(0), ['a', 'b', 'c'], ['b', 'c', 'a'])).toEqual({ kind: 'stage', at: 2 });
	});

	it('stays on a stage that is being written', () => {
		const what = stage(1);
		expect(followed(what, { '/state': pipeline('a', 'b') }, { '/state': pipeline('a', 'b of another field') })).toBe(what);
	});

	it('is the edge behind the same stage', () => {
		expect(now(edge(2), ['a', 'b'], ['x', 'a', 'b'])).toEqual({ kind: 'edge', at: 3 });
		expect(now(edge(2), ['a', 'b'], ['a'])).toEqual({ kind: 'edge', at: 1 });
		expect(now(edge(0), ['a', 'b'], ['x', 'a', 'b'])).toEqual({ kind: 'edge', at: 0 });
	});

	it('is another pipeline of the device where that one is gone, else the whole station', () => {
		const before = { '/state': pipeline('a'), '/other': pipeline() };
		expect(followed(stage(0), before, { '/other': pipeline() })).toEqual({ pipeline: '/other', part: null, example: null });
		expect(followed(stage(0), before, {})).toEqual({ pipeline: null, part: null, example: null });
	});
});
