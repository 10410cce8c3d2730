/**
 * The session of this browser as this page knows it, and the acts that change it.
 *
 * One `Session` serves all pages; components take it with `useSession()`. Other tabs of the same browser share the cookie,
 * so each tells the others when it changes, and they ask the server anew.
 */
import { createContext, flushSync } from 'svelte';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request, whenSignedOut, type Answer } from '#lib/rest/request.ts';
import type { Address, ProviderBegun, ProviderSession, Role, SessionAnswer } from '#lib/contract.ts';
import { includes } from './roles.ts';
import { ASKING, after, type Event, type Standing } from './standing.ts';

const ADDRESS = '/api/v1/session';
const CHANNEL = 'sequence-planner-session';
/** Where it is kept, for as long as the tab is there, that somebody signed out on purpose. */
const LEFT = 'signed-out';
/** Milliseconds to wait for a password to be checked: on a small machine, behind others. */
const HASHING = 20_000;
/** Milliseconds to wait for what the server asks a provider: three questions at most. */
const PROVIDER = 30_000;
/** Milliseconds for which a page is not shown yet, as the server may say by then who is signed in. */
const AT_ONCE = 250;
/** Milliseconds after which a server that did not answer is asked again, or whether a demonstration can begin by now. */
const ASK_AGAIN = 2000;

type News = 'signed-in' | 'signed-out';

export class Session {
	#standing = $state.raw<Standing>(ASKING);
	/** Somebody signed out on purpose: a demonstration does not begin again by itself in this tab. */
	#left = $state(sessionStorage.getItem(LEFT) !== null);
	/** Something that opens a session is under way. */
	#changing = false;
	/** Numbers what was asked, so that an answer that was overtaken is not taken for news. */
	#asked = 0;
	#channel: BroadcastChannel | null = null;

	/** What the server said last; null while that is not known. */
	readonly answer: SessionAnswer | null = $derived(this.#standing.state === 'known' ? this.#standing.answer : null);
	readonly state: 'asking' | SessionAnswer['state'] = $derived(this.answer?.state ?? 'asking');
	/** Why it is not known, in words; null while an answer is on its way. */
	readonly trouble: string | null = $derived(this.#standing.state === 'asking' ? this.#standing.trouble : null);
	readonly person = $derived(this.answer?.person ?? null);
	/** The public name of the session, by which control is held. */
	readonly id: string | null = $derived(this.answer?.session ?? null);
	/** What the station is called, by language; null while that is not known. */
	readonly station = $derived(this.answer?.station ?? null);
	readonly kind = $derived(this.answer?.kind ?? null);
	readonly mustChangePassword: boolean = $derived(this.answer?.must_change_password ?? false);
	/** Whether a demonstration may be opened here. */
	readonly demonstration: boolean = $derived(this.answer?.demonstration ?? false);
	/** Whether there is somebody who may sign in. */
	readonly people: boolean = $derived(this.answer?.people ?? false);
	/** The provider with which one may sign in too; null where there is none. */
	readonly provider = $derived(this.answer?.provider ?? null);
	/** The watch whose credential this browser has. */
	readonly watch = $derived(this.answer?.watch ?? null);

	/** Whether somebody signed out on purpose in this tab. */
	get left(): boolean {
		return this.#left;
	}

	/** When this page changed the password (milliseconds): a new session began with it, and all of the page with that. */
	passwordChanged: number | null = $state(null);

	/** Whether this session may do what `role` may. */
	may(role: Role): boolean {
		return includes(this.person?.role ?? null, role);
	}

	/** Listens for whatever may have ended the session, and asks the server until somebody is signed in; the result stops that. */
	attach(): () => void {
		this.#channel = new BroadcastChannel(CHANNEL);
		this.#channel.onmessage = ({ data }: MessageEvent<News>) => {
			if (data === 'signed-in') void this.check();
			else {
				this.#leave(true);
				this.doubt();
			}
		};
		const stopListening = whenSignedOut(() => void this.check());
		const look = (): void => {
			if (document.visibilityState === 'visible') void this.check();
		};
		// A page that is put away may be brought back by Back much later: it is put away empty.
		const putAway = (event: PageTransitionEvent): void => {
			if (event.persisted) flushSync(() => this.#take({ kind: 'doubted' }));
		};
		const broughtBack = (event: PageTransitionEvent): void => {
			if (event.persisted) void this.check();
		};
		document.addEventListener('visibilitychange', look);
		addEventListener('pagehide', putAway);
		addEventListener('pageshow', broughtBack);
		const again = setInterval(() => {
			const idle = this.state !== 'signed-in' && !this.#left && !this.#changing;
			if (idle && document.visibilityState === 'visible') void this.check();
		}, ASK_AGAIN);
		return () => {
			clearInterval(again);
			document.removeEventListener('visibilitychange', look);
			removeEventListener('pagehide', putAway);
			removeEventListener('pageshow', broughtBack);
			stopListening();
			this.#channel?.close();
		};
	}

	/** Asks the server how it is. */
	async check(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<SessionAnswer>('GET', ADDRESS);
		if (asked !== this.#asked) return;
		if (!answer.ok) this.#take({ kind: 'unanswered', why: answer.refusal.detail });
		else if (answer.value.state !== 'signed-in' && answer.value.demonstration && !this.#left)
			await this.openDemonstration();
		else this.#take({ kind: 'answered', answer: answer.value });
	}

	/** The session may have ended: takes everything out of sight until the server has said how it is. */
	doubt(): void {
		this.#take({ kind: 'doubted' });
		void this.check();
	}

	/** Opens the demonstration. Where that is refused one may still sign in. */
	async openDemonstration(): Promise<void> {
		this.#leave(false);
		const refusal = await this.#change('POST', `${ADDRESS}/demonstration`, {});
		if (refusal === null) return;
		this.#leave(refusal.status !== null);
		if (this.#left) await this.check();
		else this.#take({ kind: 'unanswered', why: refusal.detail });
	}

	signIn(name: string, password: string): Promise<Refusal | null> {
		this.passwordChanged = null;
		return this.#change('POST', ADDRESS, { name, password });
	}

	/** Asks where the provider signs people in, to come to the page `to` in the end; the browser is to go there. */
	beginWithProvider(to: string): Promise<Answer<ProviderBegun>> {
		return request('POST', `${ADDRESS}/provider`, { body: { to }, patience: PROVIDER });
	}

	/** Hands over what the provider has sent back; the answer has the page to go to. */
	async finishWithProvider(brought: object): Promise<Answer<ProviderSession>> {
		this.passwordChanged = null;
		this.#asked += 1;
		this.#changing = true;
		const answer: Answer<ProviderSession> = await request('POST', `${ADDRESS}/provider/answer`, {
			body: brought,
			patience: PROVIDER
		});
		this.#changing = false;
		if (answer.ok) {
			this.#take({ kind: 'answered', answer: answer.value.session });
			this.#tell('signed-in');
		}
		return answer;
	}

	/** Changes the password of who is signed in; all other sessions of that person end. */
	async changePassword(old: string, password: string): Promise<Refusal | null> {
		const refusal = await this.#change('PUT', `${ADDRESS}/password`, { old, new: password });
		if (refusal === null) this.passwordChanged = Date.now();
		return refusal;
	}

	/** Makes the first administrator, with the `token` of the link that the first start showed. */
	beFirst(token: string, name: string, password: string): Promise<Refusal | null> {
		return this.#change('POST', '/api/v1/setup', { token, name, password });
	}

	/** Ends the session. Refused, it lives on: only the server can end it. */
	async signOut(): Promise<Refusal | null> {
		const answer = await request('DELETE', ADDRESS);
		if (!answer.ok && answer.refusal.kind !== 'signed-out') return answer.refusal;
		this.#leave(true);
		this.#tell('signed-out');
		this.doubt();
		return null;
	}

	/** Sends what opens a session; the answer is that session. */
	async #change(method: 'POST' | 'PUT', path: Address, body: object): Promise<Refusal | null> {
		const asked = ++this.#asked;
		this.#changing = true;
		const answer: Answer<SessionAnswer> = await request(method, path, { body, patience: HASHING });
		this.#changing = false;
		if (!answer.ok) return answer.refusal;
		if (asked === this.#asked) this.#take({ kind: 'answered', answer: answer.value });
		else await this.check();
		this.#tell('signed-in');
		return null;
	}

	#leave(left: boolean): void {
		this.#left = left;
		if (left) sessionStorage.setItem(LEFT, '');
		else sessionStorage.removeItem(LEFT);
	}

	#take(event: Event): void {
		this.#standing = after(this.#standing, event);
	}

	#tell(news: News): void {
		this.#channel?.postMessage(news);
	}
}

const [useSession, setSession] = createContext<Session>();
export { useSession };

/** Makes the session for all components below. */
export function provideSession(session: Session): Session {
	return setSession(session);
}

/** A session after its first question to the server: with the answer, unless that takes longer than `AT_ONCE`. */
export async function askedSession(): Promise<Session> {
	const session = new Session();
	await Promise.race([session.check(), new Promise((resolve) => setTimeout(resolve, AT_ONCE))]);
	return session;
}
