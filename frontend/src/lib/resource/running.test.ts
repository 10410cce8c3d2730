import { expect, test } from 'vitest';
import type { Ability } from '#lib/contract.ts';
import { runs } from './running.ts';

test('an ability runs that was started, or that executes although nobody knows since when', () => {
	const ability: Ability = {
		resource: 'operator',
		title: 'Place',
		human: true,
		restart: false,
		moves: true,
		enabled: null,
		executing: null,
		finished: null,
		running_since: null
	};
	expect(runs(ability)).toBe(false);
	expect(runs({ ...ability, running_since: 990 })).toBe(true);
	expect(runs({ ...ability, executing: true })).toBe(true);
});
