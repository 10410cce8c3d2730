import { expect, test } from 'vitest';
import { PARTS } from '#lib/model/documents.ts';
import { pipelines as english } from '#lib/text/en/pipelines.ts';
import { pipelines as swedish } from '#lib/text/sv/pipelines.ts';

test('each kind of stage has a title of its own in each language', () => {
	const kinds = Object.keys(PARTS['stage']?.fields ?? {}).toSorted();
	for (const { kindTitles } of [english, swedish]) {
		expect(Object.keys(kindTitles).toSorted()).toEqual(kinds);
		expect(new Set(Object.values(kindTitles)).size).toBe(kinds.length);
		for (const [kind, title] of Object.entries(kindTitles)) expect(title).not.toBe(kind);
	}
});
