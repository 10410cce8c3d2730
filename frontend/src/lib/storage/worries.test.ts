import { describe, expect, it } from 'vitest';
import { SOON, worriesOf } from './worries.ts';

const growth = { per_day: 1e6, archived_per_day: 1e5, journal: 3e7, by_size: false, full_in: null };

describe('what a person should see to', () => {
	it('is nothing where all is well, and before anything is known', () => {
		expect(worriesOf({ trouble: null, missing: 0, growth })).toEqual([]);
		expect(worriesOf({ trouble: null, missing: 0, growth: null })).toEqual([]);
		expect(worriesOf({ trouble: null, missing: 0, growth: { ...growth, full_in: SOON } })).toEqual([]);
	});

	it('is trouble first, then files that are gone, then the disk', () => {
		const found = worriesOf({ trouble: 'no room', missing: 2, growth: { ...growth, full_in: 3.5 } });
		expect(found).toEqual([{ kind: 'trouble' }, { kind: 'missing' }, { kind: 'full', days: 3.5 }]);
	});
});
