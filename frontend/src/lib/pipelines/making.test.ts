import { assert, asyncProperty, constantFrom, integer, jsonValue, property, record, uniqueArray } from 'fast-check';
import { describe, expect, it } from 'vitest';
import * as yaml from 'yaml';
import type { DraftPipeline, DraftStage, Edit, Json } from '#lib/contract.ts';
import { insertion, relocation, removal, shift } from './making.ts';
import { stagesIn, textOf, type Written } from './written.ts';

const FILE = 'resources/robot.yaml';
const PATH = ['topics', '/robot/state', 'pipeline'];

/** A pipeline with stages that stand as these are written. */
function pipelineOf(written: readonly Json[]): Pick<DraftPipeline, 'stages' | 'place' | 'stages_path'> {
	const place = (path: readonly (string | number)[]) => ({ file: FILE, path: [...path], line: 1, column: 1 });
	const stages = written.map((each, at) => ({ place: place([...PATH, at]), written: each }) as unknown as DraftStage);
	return { stages, place: place(PATH.slice(0, 2)), stages_path: PATH };
}

/** What edits make of a list, as *Editing* says: an entry is put beside a sibling, else at the end. */
function edited(list: readonly Json[], edits: readonly Edit[]): Json[] {
	const now = [...list];
	for (const edit of edits) {
		if (edit.kind !== 'add' && edit.kind !== 'move' && edit.kind !== 'remove') throw new Error(edit.kind);
		const at = Number(edit.path.at(-1));
		if (edit.kind !== 'add') expect(now[at]).toEqual(edit.was);
		if (edit.kind === 'remove') {
			now.splice(at, 1);
			continue;
		}
		const { before = null, after = null } = edit;
		const value = edit.kind === 'add' ? edit.value : (now[at] as Json);
		const beside = before !== null ? Number(before) : after !== null ? Number(after) + 1 : now.length;
		expect(beside).toBeLessThanOrEqual(now.length);
		now.splice(beside, 0, value);
		if (edit.kind === 'move') now.splice(at < beside ? at : at + 1, 1);
	}
	return now;
}

const asWritten = (value: Json): Written => ({ value, text: null });

const lists = uniqueArray(integer({ min: 0, max: 50 }), { minLength: 1, maxLength: 6 });

describe('what is done to stages', () => {
	it('puts a stage at the edge where it is dropped, and the others stay in their order', () => {
		assert(
			property(lists, integer({ min: 0, max: 5 }), integer({ min: 0, max: 6 }), (list, from, to) => {
				const [index, edge] = [from % list.length, to % (list.length + 1)];
				const others = list.filter((_, at) => at !== index);
				const wanted = [...others.slice(0, edge > index ? edge - 1 : edge), list[index], ...others.slice(edge > index ? edge - 1 : edge)];
				expect(edited(list, relocation(pipelineOf(list), index, edge))).toEqual(wanted);
			})
		);
	});

	it('changes nothing where a stage stands there already, or is none that is written', () => {
		const pipeline = pipelineOf([1, 2, 3]);
		expect(relocation(pipeline, 1, 1)).toEqual([]);
		expect(relocation(pipeline, 1, 2)).toEqual([]);
		expect(relocation(pipeline, 7, 0)).toEqual([]);
		expect(shift(pipeline, 0, -1)).toEqual([]);
		expect(shift(pipeline, 2, 1)).toEqual([]);
		expect(edited([1, 2, 3], shift(pipeline, 2, -1))).toEqual([1, 3, 2]);
		expect(edited([1, 2, 3], shift(pipeline, 0, 1))).toEqual([2, 1, 3]);
	});

	it('writes stages at any edge in their order, also where there are none yet', () => {
		assert(
			property(uniqueArray(integer({ min: 0, max: 50 }), { maxLength: 5 }), lists, integer({ min: 0, max: 5 }), (list, values, to) => {
				const edge = to % (list.length + 1);
				const wanted = [...list.slice(0, edge), ...values, ...list.slice(edge)];
				expect(edited(list, insertion(pipelineOf(list), edge, values.map(asWritten)))).toEqual(wanted);
			})
		);
		expect(insertion({ ...pipelineOf([1]), stages_path: null }, 0, [asWritten(2)])).toEqual([]);
	});

	it('takes the stage out that was there', () => {
		const { stages } = pipelineOf([1, 2]);
		expect(edited([1, 2], stages[0] ? removal(stages[0]) : [])).toEqual([2]);
	});
});

describe('a stage in the clipboard', () => {
	it('is read as it was written, and what is none is not', async () => {
		// As documents are read: a zero has no sign there.
		const values = jsonValue({ maxDepth: 3 }).map((value) => JSON.parse(JSON.stringify(value)) as Json);
		const stages = record({ kind: constantFrom('rename', 'map', 'limit', 'python'), value: values });
		await assert(
			asyncProperty(stages, async ({ kind, value }) => {
				const stage: Json = { [kind]: value };
				expect((await stagesIn(textOf(yaml, stage, '', [0])))?.map((each) => each.value)).toEqual([stage]);
			})
		);
		expect(await stagesIn('limit: {seconds: 1}')).toEqual([asWritten({ limit: { seconds: 1 } })]);
		expect(await stagesIn('- limit: {seconds: 1}\n- tick: {every: 2}\n')).toHaveLength(2);
		for (const none of ['', 'hello', '- 1', '[]', 'nonsense: 1', '{limit: 1, tick: 2}', '- limit: [', 'a: &a [*a]'])
			expect(await stagesIn(none)).toBeNull();
	});
});
