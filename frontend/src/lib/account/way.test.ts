import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { sessionAnswer } from '#lib/testing/session.ts';
import { leadsTo, returnAddress, signInAddress } from './way.ts';

const ORIGIN = 'https://station.example';

describe('the address one returns to', () => {
	test.each(['/', '/users', '/journal?action=sign-in&before=7', '/a%20b?c=%2F%2Fevil'])('may be %j', (to) => {
		expect(returnAddress(to)).toBe(to);
	});

	test.each([
		null,
		'',
		'people',
		'//evil',
		'///evil',
		'/\\evil',
		'\\\\evil',
		'/\t/evil',
		'/\n/evil',
		' //evil',
		'/ /evil',
		'/.//evil',
		'/x/..//evil',
		'/%2e//evil',
		'https://evil',
		'https:evil',
		'javascript:alert(1)',
		'/users\\..\\..\\evil',
		'/sign-in?to=/users',
		'/setup'
	])('is the start page instead of %j', (to) => {
		expect(returnAddress(to)).toBe('/');
	});

	test('never leaves this server, whatever it was given', () => {
		const marks = ['/', '\\', '.', '..', '\t', '\n', ' ', ':', '@', '#', '?', '%2e', '%2f', '%5c'];
		const parts = fc.constantFrom(...marks, 'evil', 'https');
		const nasty = fc.array(parts, { maxLength: 12 }).map((each) => each.join(''));
		fc.assert(
			fc.property(fc.oneof(nasty, fc.string(), fc.webUrl(), fc.string({ unit: 'binary' })), (given) => {
				for (const to of [given, `/${given}`]) {
					const address = returnAddress(to);
					expect(address).toMatch(/^\/(?!\/)/);
					expect(new URL(address, ORIGIN).origin).toBe(ORIGIN);
					expect(returnAddress(address)).toBe(address);
				}
			}),
			{ numRuns: 2000 }
		);
	});

	test('is kept in the address of the sign-in, and read from it unchanged', () => {
		fc.assert(
			fc.property(fc.webPath(), fc.webQueryParameters(), (path, query) => {
				const page = returnAddress(`${path}?${query}`);
				const url = new URL(signInAddress(page), ORIGIN);
				expect(url.pathname).toBe('/sign-in');
				expect(returnAddress(url.searchParams.get('to'))).toBe(page);
			})
		);
	});
});

describe('a page', () => {
	const asked = (address: string): URL => new URL(ORIGIN + address);

	test('leads to the sign-in when nobody is signed in, but for those that need nobody', () => {
		const out = sessionAnswer({ state: 'signed-out' });
		expect(leadsTo(out, asked('/users?x=1'))).toBe('/sign-in?to=%2Fusers%3Fx%3D1');
		expect(leadsTo(out, asked('/'))).toBe('/sign-in');
		for (const page of ['/sign-in?to=/users', '/operator', '/setup']) expect(leadsTo(out, asked(page))).toBeNull();
	});

	test('is shown to who is signed in, and the sign-in leads back to it', () => {
		const within = sessionAnswer();
		expect(leadsTo(within, asked('/users'))).toBeNull();
		expect(leadsTo(within, asked('/sign-in?to=%2Fusers%3Fx%3D1'))).toBe('/users?x=1');
		expect(leadsTo(within, asked('/sign-in?to=//evil'))).toBe('/');
		expect(leadsTo(within, asked('/setup'))).toBe('/');
	});

	test('leads to the account, and nowhere else, while a password must be chosen', () => {
		const unready = sessionAnswer({ must_change_password: true });
		for (const page of ['/', '/users', '/operator', '/sign-in?to=/users', '/setup'])
			expect(leadsTo(unready, asked(page))).toBe('/account');
		expect(leadsTo(unready, asked('/account'))).toBeNull();
	});

	test('leads to the first start while there is nobody', () => {
		const first = sessionAnswer({ state: 'first-start', people: false });
		for (const page of ['/', '/sign-in', '/users']) expect(leadsTo(first, asked(page))).toBe('/setup');
		expect(leadsTo(first, asked('/setup'))).toBeNull();
	});

	test('leads to the sign-in where somebody may sign in, though there is no administrator', () => {
		const first = sessionAnswer({ state: 'first-start', people: true });
		expect(leadsTo(first, asked('/'))).toBe('/sign-in');
		expect(leadsTo(first, asked('/users'))).toBe('/sign-in?to=%2Fusers');
		for (const page of ['/sign-in', '/setup']) expect(leadsTo(first, asked(page))).toBeNull();
	});

	test('leads to one that leads nowhere else', () => {
		const answers = fc.record({
			state: fc.constantFrom('signed-in' as const, 'signed-out' as const, 'first-start' as const),
			people: fc.boolean(),
			must_change_password: fc.boolean()
		});
		fc.assert(
			fc.property(answers, fc.webPath(), fc.string(), (rest, path, to) => {
				const answer = sessionAnswer(rest);
				for (const address of [path === '' ? '/' : path, `/sign-in?to=${encodeURIComponent(to)}`]) {
					const next = leadsTo(answer, asked(address));
					if (next !== null) expect(leadsTo(answer, asked(next))).toBeNull();
				}
			})
		);
	});
});
