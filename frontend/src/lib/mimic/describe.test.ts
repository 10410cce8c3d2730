import { expect, test } from 'vitest';
import type { Ability, MimicSymbol } from '#lib/contract.ts';
import { view } from '#lib/testing/view.ts';
import { happening, stopOf } from './describe.ts';

const ability = (resource: string, title: string, rest: Partial<Ability> = {}): Ability => ({
	resource,
	title,
	human: false,
	restart: false,
	moves: true,
	enabled: false,
	executing: true,
	finished: false,
	running_since: 990,
	...rest
});
const resources = view({}).resources;
const station = {
	resources: { robot: { ...resources['robot'], title: 'Robot' }, operator: { ...resources['operator'], title: 'Operator' } } as typeof resources,
	abilities: { move: ability('robot', 'Move to pair 1'), place: ability('operator', 'Place a pair', { human: true }) }
};

test('what runs is told', () => {
	expect(happening(view(station))).toBe('Move to pair 1 · Place a pair');
});

test('what runs on a device that is not heard is told by nobody, held or not', () => {
	const silent = { ...station, silent: ['Robot'] };
	expect(happening(view(silent))).toBe('Place a pair · Nobody knows whether Robot moves');
	const { move } = station.abilities;
	expect(happening(view({ ...silent, abilities: { move } }))).toBe('Nobody knows whether Robot moves');
	expect(happening(view({ ...silent, abilities: { move: { ...move, executing: false, running_since: null } } }))).toBe('Nobody knows whether Robot moves');
});

test('what runs on a device that fails is told as that', () => {
	expect(happening(view({ ...station, failing: ['Robot'] }))).toBe('Place a pair · Robot does not go on');
});

test('where an ability leads is called as the picture calls the stop, and nothing where it has no name', () => {
	const stop = (value: string, title: Record<string, string>) => ({ value, title, x: 0, y: 0, label: 'none' as const, room: 0, branch: false });
	const symbol = { track: { stops: [stop('pair_1', { en: 'Pair 1', sv: 'Par 1' }), stop('far', {})] } } as unknown as MimicSymbol;
	expect(stopOf(symbol, 'robot.move(pair_1)', 'sv')).toBe('Par 1');
	expect(stopOf(symbol, 'robot.move(far)', 'en')).toBeNull();
	expect(stopOf(symbol, 'robot.open', 'en')).toBeNull();
	expect(stopOf({ ...symbol, track: null }, 'robot.move(pair_1)', 'en')).toBeNull();
});
