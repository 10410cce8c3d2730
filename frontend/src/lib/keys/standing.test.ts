import { expect, test } from 'vitest';
import type { Key } from '#lib/contract.ts';
import { example, standingOf } from './standing.ts';

const KEY: Key = {
	id: 'k1',
	name: 'MES',
	scopes: ['read'],
	created: 0,
	created_by: 'Eva',
	expires: 100,
	last_used: null,
	revoked: null,
	former_until: null
};

test('a key is of use until it expires or is revoked', () => {
	expect(standingOf(KEY, 99.9)).toBe('valid');
	expect(standingOf(KEY, 100)).toBe('expired');
	expect(standingOf({ ...KEY, revoked: 5 }, 99)).toBe('revoked');
	expect(standingOf({ ...KEY, revoked: 5 }, 200)).toBe('revoked');
});

test('the example reads what the key may read, and holds no secret', () => {
	expect(example(['audit', 'read'], 'https://station:8443')).toBe(
		'curl --header @- https://station:8443/api/v1/station <<< "Authorization: Bearer $KEY"'
	);
	expect(example(['audit'], 'https://station')).toContain('/api/v1/audit');
	expect(example(['metrics'], 'https://station')).toContain('https://station/metrics ');
});
