/** Answers about the session for tests. */
import type { SessionAnswer } from '#lib/contract.ts';

/** An operator who is signed in, with what a test is about put in. */
export function sessionAnswer(rest: Partial<SessionAnswer> = {}): SessionAnswer {
	const person = { id: 'p-1', name: 'Operator A', role: 'operator' as const, issuer: null };
	const signedIn: SessionAnswer = {
		state: 'signed-in',
		people: true,
		station: { en: 'Bolt tightening station', sv: 'Station för skruvdragning' },
		person,
		session: 's-1',
		kind: 'person',
		must_change_password: false,
		version: null,
		expires: 2000,
		demonstration: false,
		watch: null,
		provider: null,
		...rest
	};
	return signedIn.state === 'signed-in' ? signedIn : { ...signedIn, person: null, session: null, kind: null, expires: null };
}
