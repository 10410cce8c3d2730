import { expect, test } from 'vitest';
import { view } from '#lib/testing/view.ts';
import { isWell } from './mode-marks.ts';

test('automatic looks like well-being only while nothing is known to be wrong with the station', () => {
	const well = view({ mode: 'automatic', production: 'started', standing: 'working' });
	expect(isWell(well)).toBe(true);
	// A device is not heard: what is shown of it may not be so.
	expect(isWell({ ...well, standing: 'silent', silent: ['Robot UR10'] })).toBe(false);
	for (const standing of ['waiting', 'held', 'restart', 'paused', 'stopped', 'preparing'] as const)
		expect(isWell({ ...well, standing })).toBe(false);
	const way_back = { violated: [], differences: [], awaits: [] } as never;
	expect(isWell({ ...well, way_back })).toBe(false);
});
