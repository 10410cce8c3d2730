import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import type { SessionAnswer } from '#lib/contract.ts';
import { sessionAnswer } from '#lib/testing/session.ts';
import { Session } from './session.svelte.ts';

type Asked = { readonly line: string; readonly answer: (status: number, body?: object) => Promise<void> };

/** What the page asks of the server, answered by the test. */
let asked: Asked[] = [];
const kept = new Map<string, string>();
const OUT = sessionAnswer({ state: 'signed-out' });

beforeEach(() => {
	asked = [];
	kept.clear();
	vi.stubGlobal('sessionStorage', {
		getItem: (key: string) => kept.get(key) ?? null,
		setItem: (key: string, value: string) => kept.set(key, value),
		removeItem: (key: string) => kept.delete(key)
	});
	vi.stubGlobal('fetch', (path: string, { method }: RequestInit) => {
		return new Promise<Response>((resolve, reject) => {
			asked.push({
				line: `${method} ${path.replace('/api/v1', '')}`,
				answer: (status, body) => {
					if (status === 0) reject(new TypeError('refused'));
					else resolve(new Response(body === undefined ? null : JSON.stringify(body), { status }));
					return settled();
				}
			});
		});
	});
});
afterEach(() => vi.unstubAllGlobals());

function settled(): Promise<void> {
	return new Promise((resolve) => setTimeout(resolve));
}

function taken(k: number): Asked {
	const found = asked[k];
	if (found === undefined) throw new Error(`only ${asked.length} were asked`);
	return found;
}

async function known(answer: SessionAnswer): Promise<Session> {
	const session = new Session();
	void session.check();
	await taken(0).answer(200, answer);
	asked = [];
	return session;
}

test('nothing is known until the server has answered, and it is said when it does not', async () => {
	const session = new Session();
	void session.check();
	expect([session.state, session.trouble, session.may('viewer')]).toEqual(['asking', null, false]);
	await taken(0).answer(0);
	expect(session.state).toBe('asking');
	expect(session.trouble).toContain('cannot be reached');
	void session.check();
	await taken(1).answer(200, sessionAnswer());
	expect([session.state, session.trouble, session.may('operator'), session.may('engineer')]).toEqual([
		'signed-in',
		null,
		true,
		false
	]);
});

test('an answer that was overtaken is not taken for news', async () => {
	const session = await known(OUT);
	void session.check();
	const signingIn = session.signIn('Operator A', 'a few long words');
	await taken(1).answer(200, sessionAnswer());
	await taken(0).answer(200, OUT);
	expect(await signingIn).toBeNull();
	expect(session.state).toBe('signed-in');
});

test('a wrong password leaves everything as it is', async () => {
	const session = await known(OUT);
	const signingIn = session.signIn('Operator A', 'wrong');
	await taken(0).answer(401, { type: '/problems/wrong-name-or-password', title: 'Not signed in', detail: 'Wrong.' });
	expect(await signingIn).toMatchObject({ kind: 'wrong-name-or-password' });
	expect(session.state).toBe('signed-out');
});

test('signing out takes everything out of sight; refused, it does not pretend to', async () => {
	const session = await known(sessionAnswer());
	const refused = session.signOut();
	await taken(0).answer(0);
	expect(await refused).toMatchObject({ status: null });
	expect(session.state).toBe('signed-in');

	const done = session.signOut();
	await taken(1).answer(204);
	expect(await done).toBeNull();
	expect(session.state).toBe('asking');
	expect(taken(2).line).toBe('GET /session');
	await taken(2).answer(200, OUT);
	expect(session.state).toBe('signed-out');
});

test('a demonstration opens by itself, and not again after somebody signed out', async () => {
	const open = { ...OUT, demonstration: true };
	const session = new Session();
	void session.check();
	await taken(0).answer(200, open);
	expect(taken(1).line).toBe('POST /session/demonstration');
	await taken(1).answer(200, sessionAnswer({ kind: 'demonstration', demonstration: true }));
	expect([session.state, session.kind]).toEqual(['signed-in', 'demonstration']);

	void session.signOut();
	await taken(2).answer(204);
	await taken(3).answer(200, open);
	expect(asked).toHaveLength(4);
	expect([session.state, session.demonstration]).toEqual(['signed-out', true]);

	const loadedAnew = new Session();
	void loadedAnew.check();
	await taken(4).answer(200, open);
	expect(asked).toHaveLength(5);
	expect(loadedAnew.state).toBe('signed-out');
});

test('a demonstration that is refused leaves the way to sign in', async () => {
	const session = new Session();
	void session.check();
	await taken(0).answer(200, { ...OUT, demonstration: true });
	await taken(1).answer(403, { type: '/problems/no-demonstration', title: 'No', detail: 'No.' });
	await taken(2).answer(200, OUT);
	expect([session.state, asked.length]).toEqual(['signed-out', 3]);
});
