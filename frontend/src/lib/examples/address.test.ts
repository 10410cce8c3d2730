import fc from 'fast-check';
import { expect, test } from 'vitest';
import { addressOf as inModel, besideText, lookedAt as lookedAtInModel } from '#lib/model/address.ts';
import { addressOf as inPipelines, lookedAt as lookedAtInPipelines } from '#lib/pipelines/address.ts';
import { addressOf as inOperations, lookedAt as lookedAtInOperations } from '#lib/sequence/address.ts';
import { addressOf as inGraph, lookedAt as lookedAtInGraph } from '#lib/station/address.ts';
import { askedOf, exampleIn, shownAt } from './address.ts';

const queryOf = (address: string): URLSearchParams => new URL(address, 'http://station').searchParams;

test('an address says which example is shown, and nothing where none is', () => {
	expect(shownAt('/model', null)).toBe('/model');
	expect(shownAt('/model', 'single_bolt')).toBe('/model?example=single_bolt');
	expect(shownAt('/operations', null, { operation: 'a b' })).toBe('/operations?operation=a+b');
	expect(exampleIn(queryOf('/model?example='))).toBeNull();
});

test('whatever else is looked at, the same example stays', () => {
	const name = fc.stringMatching(/^[a-z_]{1,20}$/);
	fc.assert(
		fc.property(name, fc.dictionary(name, fc.string()), (example, looked) => {
			const query = queryOf(shownAt('/pipelines', example, looked));
			expect(exampleIn(query)).toBe(example);
			for (const [key, value] of Object.entries(looked)) if (key !== 'example') expect(query.get(key)).toBe(value);
		})
	);
});

test('the pages lead from one thing to the next within an example', () => {
	const query = new URLSearchParams({ example: 'docking_agv' });
	for (const address of [
		inModel({ ...lookedAtInModel(query), entry: 'operations.yaml' }),
		besideText(query, false),
		inGraph({ ...lookedAtInGraph(query), thing: 'topic:/a' }),
		inOperations({ ...lookedAtInOperations(query), operation: 'dock' }),
		inPipelines({ ...lookedAtInPipelines(query), pipeline: '/agv' })
	])
		expect(exampleIn(queryOf(address)), address).toBe('docking_agv');
});

test('a question is about the draft, or names the example', () => {
	expect(askedOf('/api/v1/model/graph', null)).toBe('/api/v1/model/graph');
	expect(askedOf('/api/v1/model/files', 'single_bolt', [['path', 'a.yaml'], ['path', 'b.yaml']])).toBe('/api/v1/model/files?path=a.yaml&path=b.yaml&example=single_bolt');
});
