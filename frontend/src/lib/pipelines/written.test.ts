import { expect, test } from 'vitest';
import * as yaml from 'yaml';
import { parse } from 'yaml';
import type { Json } from '#lib/contract.ts';
import { stagesIn, textOf } from './written.ts';

const FILE = `title: Robot
topics:
  /robot/state:
    type: a/msg/B
    pipeline: # in this order
      # near enough,
      # as measured
      - discretise: # by hand
          field: joints
          tolerance: &near 0.1 # rad
          points: &points {home: [0, 1]}
      # at most this often
      - limit: {every: 1.0} # s

      - debounce:
          fields: [pose]
          # as near as that
          seconds: *near
      - map: *points
`;
const PATH = ['topics', '/robot/state', 'pipeline'];
const stage = (at: number): Json => (parse(FILE) as { topics: Record<string, { pipeline: Json[] }> }).topics['/robot/state']?.pipeline[at] ?? null;
const copied = (at: number): string => textOf(yaml, stage(at), FILE, [...PATH, at]);

test('a stage is copied with the comments in it and directly above, and no anchor', () => {
	expect(copied(0)).toBe(`# near enough,
# as measured
- discretise: # by hand
    field: joints
    tolerance: 0.1 # rad
    points: {home: [0, 1]}
`);
	expect(copied(1)).toBe('# at most this often\n- limit: {every: 1.0} # s\n');
});

test('what an alias stands for is written where it stood', () => {
	const text = copied(2);
	expect(text).toContain('    # as near as that\n    seconds: 0.1\n');
	expect(text).not.toContain('at most');
	expect(copied(3)).toBe('- map: {home: [0, 1]}\n');
});

test('what the file does not have so is copied as it is known', () => {
	expect(textOf(yaml, { limit: { every: 2 } }, FILE, [...PATH, 1])).toBe('- limit:\n    every: 2\n');
	expect(textOf(yaml, { limit: { every: 2 } }, 'a: [', [...PATH, 1])).toBe('- limit:\n    every: 2\n');
});

test('pasted stages keep their comments, each its own, whatever names and aliases there were', async () => {
	const all = await stagesIn([0, 1, 3].map(copied).join(''));
	expect(all?.map(({ value }) => value)).toEqual([stage(0), stage(1), stage(3)]);
	expect(all?.map(({ text }) => text)).toEqual([
		'# near enough,\n# as measured\ndiscretise: # by hand\n  field: joints\n  tolerance: 0.1 # rad\n  points: {home: [0, 1]}\n',
		'# at most this often\nlimit: {every: 1.0} # s\n',
		null
	]);
	expect(await stagesIn('- limit: &a {every: 2} # s\n- limit: *a\n')).toEqual([
		{ value: { limit: { every: 2 } }, text: 'limit: {every: 2} # s\n' },
		{ value: { limit: { every: 2 } }, text: null }
	]);
	expect(await stagesIn('limit: {every: 2}')).toEqual([{ value: { limit: { every: 2 } }, text: null }]);
	for (const nothing of ['', 'a: 1', '- 3', '- limit: *gone', '[', 'word']) expect(await stagesIn(nothing)).toBeNull();
});
