import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import type { Path } from './content.ts';
import { placeOf, placesOf } from './places.ts';
import { valueText, withValue } from './yaml-value.ts';

const MODELS = join(import.meta.dirname, '../../../../models');
const TEXT = `topics:
  /robot/state:
    type: a/msg/B # its state
    pipeline:
      # joint angles in rad
      - discretise:
          values: &poses
            home: [0.0, 1.5]

      - remember: {of: pose}
    examples: []
  /robot/command: {type: a/msg/C}
  "/robot/more": &more
    type: a/msg/D
flows:
  both:
    from: [/robot/state, /robot/more] # the two
`;
const there = (text: string, ...path: string[]): NonNullable<ReturnType<typeof placeOf>> => {
	const found = placeOf(placesOf(text), path as Path);
	if (found?.path.length !== path.length) throw new Error(`no ${path.join(' ')}`);
	return found;
};
const PIPELINE = ['topics', '/robot/state', 'pipeline'];

describe('the value of an entry', () => {
	test('is what stands behind its key, as if it stood alone', () => {
		expect(valueText(TEXT, there(TEXT, ...PIPELINE))).toBe(
			'# joint angles in rad\n- discretise:\n    values: &poses\n      home: [0.0, 1.5]\n\n- remember: {of: pose}'
		);
		expect(valueText(TEXT, there(TEXT, 'topics', '/robot/state', 'examples'))).toBe('[]');
		expect(valueText(TEXT, there(TEXT, 'topics', '/robot/more'))).toBe('&more\ntype: a/msg/D');
		expect(valueText(TEXT, there(TEXT, 'flows', 'both', 'from'))).toBe('[/robot/state, /robot/more] # the two');
	});

	test('written back, it leaves the file as it was, in the models of this repository too', () => {
		const texts = readdirSync(MODELS, { recursive: true, encoding: 'utf8' })
			.filter((each) => each.endsWith('.yaml'))
			.map((each) => readFileSync(join(MODELS, each), 'utf8'));
		for (const text of [TEXT, ...texts])
			for (const place of placesOf(text)) {
				// Items have no key, and no field of their own.
				if (place.path.some((step) => typeof step === 'number')) continue;
				expect(withValue(text, place, valueText(text, place)), place.path.join(' ')).toBe(text);
			}
	});

	test.each([
		['- rename: {a: b}\n- constant: {c: 1}', '    pipeline:\n      - rename: {a: b}\n      - constant: {c: 1}\n    examples'],
		['    - rename:\n        a: b', '    pipeline:\n      - rename:\n          a: b\n    examples'],
		['[{rename: {a: b}}]', '    pipeline: [{rename: {a: b}}]\n    examples'],
		['[\n  {rename: {a: b}}\n]\n\n', '    pipeline: [\n        {rename: {a: b}}\n      ]\n    examples'],
		['*poses', '    pipeline: *poses\n    examples'],
		['"a: b": c\nd: e', '    pipeline:\n      "a: b": c\n      d: e\n    examples'],
		['/robot/state', '    pipeline: /robot/state\n    examples'],
		['left: /robot/state', '    pipeline:\n      left: /robot/state\n    examples']
	])('%j takes its place below or beside the key', (value, expected) => {
		expect(withValue(TEXT, there(TEXT, ...PIPELINE), value)).toContain(expected);
	});
});
