import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { holderOf, holderText } from './holder.ts';
import { tokenOf } from './link-token.ts';
import { passwordTrouble } from './password-rules.ts';
import { roleOf } from './pages.ts';
import { secondsLeft, waitText } from './retry.ts';
import { ROLES, includes } from './roles.ts';

test('each role includes those before it and itself, and nobody has none', () => {
	ROLES.forEach((held, k) => {
		expect(ROLES.filter((wanted) => includes(held, wanted))).toEqual(ROLES.slice(0, k + 1));
	});
	expect(ROLES.some((wanted) => includes(null, wanted))).toBe(false);
});

test('pages have the lowest role that may see them', () => {
	const pages = ['/', '/account', '/journal', '/wearables', '/users', '/api-keys', '/nowhere'];
	expect(pages.map(roleOf)).toEqual([
		'viewer',
		'viewer',
		'operator',
		'operator',
		'administrator',
		'administrator',
		'viewer'
	]);
});

describe('a wait', () => {
	test.each([
		[1, '1 s'],
		[40, '40 s'],
		[60, '1 min'],
		[65, '1 min 5 s'],
		[900, '15 min'],
		[7200, '2 h']
	])('of %i seconds is said as %s', (seconds, text) => {
		expect(waitText(seconds)).toBe(text);
	});

	test('counts down to 0 and is never over too soon', () => {
		fc.assert(
			fc.property(fc.nat(100_000), fc.nat(200_000), (wait, passed) => {
				const left = secondsLeft(wait, passed);
				expect(left === 0).toBe(passed >= wait);
				expect(passed + left * 1000).toBeGreaterThanOrEqual(wait);
			})
		);
	});
});

describe('a password', () => {
	test.each([
		['eleven char', 'characters'],
		['x'.repeat(257), 'at most 256'],
		['aaaaaaaaaaaa', 'over and over'],
		['hello OPERATOR A hello', 'the name'],
		['ｏｐｅｒａｔｏｒ a and more', 'the name']
	])('%j is refused in words', (password, words) => {
		expect(passwordTrouble(password, ' Operator A ')).toContain(words);
	});

	test('of a few words is well, also before there is a name', () => {
		expect(passwordTrouble('four words and a bit', 'Operator A')).toBeNull();
		expect(passwordTrouble('four words and a bit', '')).toBeNull();
		expect(passwordTrouble('🔩🔧🔩🔧🔩🔧🔩🔧🔩🔧🔩🔧', 'Operator A')).toBeNull();
	});
});

test('the token of a link is what stands behind the #, and only if it looks like one', () => {
	expect(tokenOf('#aZ_9-x')).toBe('aZ_9-x');
	for (const hash of ['', '#', '#a b', '#<b>', '#a#b', `#${'x'.repeat(201)}`]) expect(tokenOf(hash)).toBeNull();
});

test('control is yours in the session that took it; elsewhere it is still said to be you', () => {
	const control = { session: 's-1', person: 'p-1', name: 'Operator A', since: 0, taken_from: null };
	const holders = [
		holderOf(null, 's-1', 'p-1'),
		holderOf(control, 's-1', 'p-1'),
		holderOf(control, 's-2', 'p-1'),
		holderOf(control, 's-2', 'p-2'),
		holderOf(control, 's-2', null)
	];
	expect(holders).toEqual(['nobody', 'you', 'you-elsewhere', 'another', 'another']);
	expect(holderText(null, 'nobody')).toBe('nobody');
	expect(holderText(control, 'another')).toBe('Operator A');
});
