import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { pathAt, placeOf, placesOf } from './places.ts';

const MODELS = join(import.meta.dirname, '../../../../models');
const TEXT = `# what it is
title: Robot

topics:
  /robot/state: {type: a/msg/B, direction: in}
  "/robot/command":
    type: a/msg/C
    pipeline:
      - rename: {a: b}
      # the second
      - table:
          fields: [
            one,
            two
          ]
          rows:
          - {when: [true]}

abilities:
  move:
    enabled: >-
      a: b and
      c
    start:
      do:
        - x := y
        - z := w if a
    finished: true # at once
`;
const line = (text: string): number => TEXT.split('\n').indexOf(text) + 1;

describe('where entries stand', () => {
	const places = placesOf(TEXT);
	test('each line leads to the innermost entry it belongs to', () => {
		expect(pathAt(places, line('title: Robot'))).toEqual(['title']);
		expect(pathAt(places, line('  /robot/state: {type: a/msg/B, direction: in}'))).toEqual(['topics', '/robot/state']);
		expect(pathAt(places, line('      - rename: {a: b}'))).toEqual(['topics', '/robot/command', 'pipeline', 0, 'rename']);
		expect(pathAt(places, line('            two'))).toEqual(['topics', '/robot/command', 'pipeline', 1, 'table', 'fields']);
		expect(pathAt(places, line('          - {when: [true]}'))).toEqual([
			'topics', '/robot/command', 'pipeline', 1, 'table', 'rows', 0
		]);
		expect(pathAt(places, line('      a: b and'))).toEqual(['abilities', 'move', 'enabled']);
		expect(pathAt(places, line('        - z := w if a'))).toEqual(['abilities', 'move', 'start', 'do', 1]);
		expect(pathAt(places, line('    finished: true # at once'))).toEqual(['abilities', 'move', 'finished']);
		expect(pathAt(places, 1)).toEqual([]);
	});

	test('an entry has all its lines, and what is not there the nearest around it', () => {
		const place = placeOf(places, ['abilities', 'move', 'start', 'when']);
		expect(place?.path).toEqual(['abilities', 'move', 'start']);
		expect(place && TEXT.split('\n').slice(place.from, place.to)).toEqual(['    start:', '      do:', '        - x := y', '        - z := w if a']);
		expect(placeOf(places, ['nothing'])).toBeNull();
	});

	test('in the models of this repository each name that begins a line is found', () => {
		for (const file of readdirSync(MODELS, { recursive: true, encoding: 'utf8' }).filter((each) => each.endsWith('.yaml'))) {
			const text = readFileSync(join(MODELS, file), 'utf8');
			const found = placesOf(text);
			text.split('\n').forEach((each, index) => {
				const name = /^ *(?:- )?([a-z_]\w*):(?: |$)/.exec(each)?.[1];
				if (name !== undefined) expect(pathAt(found, index + 1).at(-1), `${file}:${index + 1}`).toBe(name);
			});
		}
	});
});
