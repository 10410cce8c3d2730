import fc from 'fast-check';
import { expect, test } from 'vitest';
import { Titles, type PartNames } from './titles.ts';

const NONE: PartNames = { station: {}, resources: {}, abilities: {}, tasks: {}, operations: {}, specifications: {}, work_masters: {} };
const NAMES: PartNames = {
	...NONE,
	station: { en: 'Bolt station', sv: 'Skruvstation' },
	resources: { robot: { en: 'Robot', sv: 'Roboten' }, tool: { en: 'Tool', sv: 'Verktyget' }, other: { en: 'Tool', sv: 'Redskapet' } },
	abilities: { 'robot.move(home)': { en: 'Move home', sv: 'Kör hem' } },
	tasks: { 'robot.move(home)': { en: 'Push the arm home.', sv: 'För armen hem.' } },
	operations: { tighten: { en: 'Tighten', sv: 'Dra åt' } },
	work_masters: { engine: { en: 'An engine', sv: 'En motor' } }
};
const swedish = (): Titles => new Titles(NAMES, 'sv');

test('a title is told in the language where it and the name beside or above it are those of a part', () => {
	const view = {
		station: { name: 'bolts', title: 'Bolt station' },
		resources: { robot: { title: 'Robot', online: true } },
		operations: { tighten: { title: 'Tighten' } },
		plan: { steps: [{ ability: 'robot.move(home)', title: 'Move home', resource: 'robot' }] },
		tasks: { 'a-1': { ability: 'robot.move(home)', title: 'Move home', text: 'Push the arm home.', movers: [{ name: 'tool', title: 'Tool', moves: ['Move home', 'Tool', 'Fan'] }] } },
		in_work: [{ job: null, work_master: 'engine', title: 'An engine' }],
		silent: ['Robot']
	};
	expect(swedish().in(view)).toEqual({
		station: { name: 'bolts', title: 'Skruvstation' },
		resources: { robot: { title: 'Roboten', online: true } },
		operations: { tighten: { title: 'Dra åt' } },
		plan: { steps: [{ ability: 'robot.move(home)', title: 'Kör hem', resource: 'robot' }] },
		tasks: {
			'a-1': { ability: 'robot.move(home)', title: 'Kör hem', text: 'För armen hem.', movers: [{ name: 'tool', title: 'Verktyget', moves: ['Kör hem', 'Tool', 'Fan'] }] }
		},
		in_work: [{ job: null, work_master: 'engine', title: 'En motor' }],
		silent: ['Roboten']
	});
});

test('what people have written stays, and so does what another model calls a part', () => {
	const jobs = { jobs: { '1': { id: '1', title: 'Robot' } }, by: 'Robot', note: { text: 'Push the arm home.' } };
	expect(swedish().in(jobs)).toBe(jobs);
	const other = { resources: { robot: { title: 'Old robot' } } };
	expect(swedish().in(other)).toBe(other);
});

test('in the language in which they are sent, and without names, documents stay as they are', () => {
	const view = { resources: { robot: { title: 'Robot' } }, silent: ['Robot'] };
	expect(new Titles(NAMES, 'en').in(view)).toBe(view);
	expect(new Titles(null, 'sv').in(view)).toBe(view);
});

test('a document in one language is told in another as if it had come so', () => {
	const view = { resources: { robot: { title: 'Robot' } } };
	const told = swedish().in(view);
	expect(new Titles(NAMES, 'en').in(told)).toBe(view);
	expect(swedish().in(told)).toEqual({ resources: { robot: { title: 'Roboten' } } });
	expect(new Titles(null, 'sv').in(told)).toBe(view);
});

test('after a change only what has changed is another: the rest keeps its identity', () => {
	const titles = swedish();
	const before = { time: 1, resources: { robot: { title: 'Robot', online: true }, tool: { title: 'Tool', online: true } } };
	const first = titles.in(before);
	const after = { ...before, time: 2, resources: { ...before.resources, robot: { title: 'Robot', online: false } } };
	const second = titles.in(after);
	expect(second.resources.tool).toBe(first.resources.tool);
	expect(second.resources.robot).toEqual({ title: 'Roboten', online: false });
	expect(titles.in({ ...after, time: 3 }).resources).toBe(second.resources);
});

test('change by change the same is told as of the whole at once', () => {
	const name = fc.constantFrom('robot', 'tool', 'fan');
	const part = fc.record({ title: fc.constantFrom('Robot', 'Tool', 'Fan'), online: fc.boolean() });
	fc.assert(
		fc.property(fc.array(fc.tuple(name, part), { maxLength: 12 }), (changes) => {
			const titles = swedish();
			let resources: Record<string, { title: string; online: boolean }> = {};
			for (const [which, now] of changes) {
				resources = { ...resources, [which]: now };
				expect(titles.in({ resources })).toEqual(swedish().in({ resources: structuredClone(resources) }));
			}
		})
	);
});

test('what has no title is called by its name, as a heading, and one of several is told from the others', () => {
	const name = 'operator.place_pair(pair_3)';
	const known = { ...NONE, abilities: { [name]: { '': 'place pair', en: 'Place pair 3', sv: 'Place pair 3' } } };
	const view = {
		station: { name: 'bolt_station', title: 'bolt_station' },
		resources: { smart_tool: { title: 'smart tool' }, robot: { title: 'the robot' } },
		plan: { steps: [{ ability: name, title: 'place pair' }] },
		operations: { bring_kit: { title: 'bring kit' } }
	};
	expect(new Titles(known, 'en').in(view)).toEqual({
		station: { name: 'bolt_station', title: 'Bolt station' },
		resources: { smart_tool: { title: 'Smart tool' }, robot: { title: 'the robot' } },
		plan: { steps: [{ ability: name, title: 'Place pair 3' }] },
		operations: { bring_kit: { title: 'Bring kit' } }
	});
});
