/**
 * A draft that is tried with emulated devices: its clock, which goes on as fast as somebody wants, and all that has happened.
 *
 * The server lets time pass; here it is asked to, again and again. Where somebody looks back, what is done begins anew there.
 */
import type { Advance, ScenarioExpectation, ScenarioRun, Tried, TriedMoment, TryBody, WrittenScenario } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request, type Answer } from '#lib/rest/request.ts';
import { countAt, lanesOf, valuesAfter, type Chapter } from './runs.ts';

/** Milliseconds: the server prepares the model first. */
const PATIENCE = 90_000;
/** Milliseconds between two questions as the clock runs. */
const BEAT = 500;
/** Seconds for which what somebody does is waited for to show. */
const REACTION = 0.2;
/** Seconds in which one step or a condition is waited for at most. */
const LONGEST_STEP = 120;
const LONGEST_RUN = 600;

export const SPEEDS = [1, 2, 5, 10, 30] as const;

const ADDRESS = '/api/v1/model/simulations';
const NOTHING: Advance = { at: null, faults: [], sets: {}, done: [], seconds: 0, until: null, once: false, people_wait: false };

export class TryOut {
	/** How it stood when it was told last. */
	told = $state.raw<Tried | null>(null);
	moments = $state.raw<readonly TriedMoment[]>([]);
	/** The models that were tried, the first from the beginning on. */
	chapters = $state.raw<readonly Chapter[]>([]);
	/** Seconds after the beginning: the moment that is looked at. */
	at = $state(0);
	plays = $state(false);
	/** Time passes until something happens, as fast as the server can. */
	seeks = $state(false);
	speed = $state<(typeof SPEEDS)[number]>(1);
	/** People do their tasks when somebody says so, and not by themselves. */
	peopleWait = $state(false);
	refusal = $state.raw<Refusal | null>(null);
	pending = $state(false);
	/** The scenario that it began with, as it ran. */
	scenario = $state.raw<ScenarioRun | null>(null);
	/** It was begun again, as the server had forgotten it. */
	forgotten = $state(false);
	#asked = 0;
	#timer: ReturnType<typeof setTimeout> | null = null;
	#closed = false;
	/** What the server is asked now. */
	#under: Promise<unknown> = Promise.resolve();

	/** The time that has passed. */
	readonly head = $derived(this.told?.seconds ?? 0);
	readonly isAtHead = $derived(this.at >= this.head - 0.05);
	/** How many moments have been by the one that is looked at. */
	readonly count = $derived(this.isAtHead ? this.moments.length : countAt(this.moments, this.at));
	readonly moment = $derived(this.moments[this.count - 1] ?? null);
	readonly chapter = $derived(this.chapters.findLast(({ index }) => index <= this.count) ?? null);
	readonly values = $derived(valuesAfter(this.chapters, this.moments, this.count));
	readonly running = $derived(this.moment?.running ?? this.chapter?.model.running ?? []);
	readonly active = $derived(this.moment?.active ?? this.chapter?.model.active ?? []);
	readonly safe = $derived(this.moment?.safe ?? this.chapter?.model.safe ?? true);
	readonly lanes = $derived(lanesOf(this.chapters, this.moments, this.head, this.told?.plan ?? []));

	/** Begins anew: as the model begins, from a record, from values, with a scenario, or without any of them from the station as it is. */
	async begin(from: Partial<TryBody> = {}): Promise<void> {
		this.pause();
		const asked = ++this.#asked;
		this.pending = true;
		const body: TryBody = { fresh: false, number: null, present: null, scenario: null, ...from };
		const asking = request<Tried>('POST', ADDRESS, { body, signal: AbortSignal.timeout(PATIENCE) });
		this.#under = asking;
		const answer = await asking;
		if (asked !== this.#asked || this.#closed) return;
		this.pending = this.forgotten = false;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		[this.moments, this.chapters, this.at] = [[], [], 0];
		this.scenario = answer.value.scenario ?? null;
		this.#take(answer.value, answer.value.seconds);
	}

	play(): void {
		if (this.plays || this.told?.id == null) return;
		this.plays = true;
		void this.#beat();
	}

	pause(): void {
		this.plays = this.seeks = false;
		if (this.#timer !== null) clearTimeout(this.#timer);
		this.#timer = null;
	}

	/** Looks at a moment; time stands still there. */
	look(seconds: number): void {
		this.pause();
		this.at = Math.max(this.chapters[0]?.seconds ?? 0, Math.min(this.head, seconds));
	}

	/** The moment before the one that is looked at. */
	back(): void {
		const before = this.moments.slice(0, this.count).findLast(({ seconds }) => seconds < this.at - 0.01);
		this.look(before?.seconds ?? 0);
	}

	/** The next thing that happens: what is known already, or what comes. */
	async step(): Promise<void> {
		const next = this.isAtHead ? null : this.moments[this.count];
		if (next) this.look(next.seconds);
		else await this.act({ seconds: LONGEST_STEP, once: true });
	}

	/** Lets time pass until a condition comes to hold. */
	async runUntil(until: string): Promise<void> {
		await this.act({ seconds: LONGEST_RUN, until });
	}

	/** Does something at the moment that is looked at. What is known to come after it is no more. */
	async act(what: Partial<Advance>): Promise<void> {
		const plays = this.plays;
		this.pause();
		await this.#under; // what is under way counts
		if (this.at < (this.chapters.at(-1)?.seconds ?? 0)) {
			await this.begin({ present: this.values });
			if (this.refusal !== null || this.told?.id == null) return;
		}
		const { seconds = 0, until = null, once = false } = what;
		const ends = this.at + seconds;
		this.seeks = seconds > 0;
		let goesOn = await this.#advance({ ...what, ...(this.isAtHead ? {} : { at: this.at }) });
		// What takes the server long is told piece by piece.
		while (goesOn && this.seeks && this.told?.stopped === 'late') goesOn = await this.#advance({ seconds: Math.max(0, ends - this.head), until, once });
		this.seeks = false;
		if (goesOn && plays) this.play();
	}

	/** Does something with tasks or devices, and lets the station react. */
	async deed(what: Pick<Partial<Advance>, 'sets' | 'done' | 'faults'>): Promise<void> {
		await this.act({ ...what, seconds: REACTION, once: true });
	}

	/** The scenario that it becomes, up to the moment that is looked at. */
	async written(expected: Partial<ScenarioExpectation>): Promise<Answer<WrittenScenario> | null> {
		const id = this.told?.id;
		if (id == null) return null;
		const body: ScenarioExpectation = { at: this.at, title: '', holds: null, starts: false, ...expected };
		return await request<WrittenScenario>('POST', `${ADDRESS}/${id}/scenario`, { body, signal: AbortSignal.timeout(PATIENCE) });
	}

	/** The draft is another one: it goes on with that. */
	async follow(number: number): Promise<void> {
		if (this.told === null || this.pending || this.told.number === number) return;
		if (this.told.id === null) await this.begin();
		else if (!this.plays) await this.#advance({});
	}

	/** Nobody looks any more. */
	close(): void {
		this.#closed = true;
		this.pause();
	}

	async #beat(): Promise<void> {
		const began = performance.now();
		const seconds = (this.speed * BEAT) / 1000;
		if (!this.isAtHead) this.at = Math.min(this.head, this.at + seconds);
		else if (!(await this.#advance({ seconds })) && this.plays) this.pause();
		if (this.plays) this.#timer = setTimeout(() => void this.#beat(), Math.max(0, BEAT - (performance.now() - began)));
	}

	async #advance(what: Partial<Advance>): Promise<boolean> {
		const id = this.told?.id;
		if (id == null || this.pending) return false;
		const asked = ++this.#asked;
		this.pending = true;
		const body: Advance = { ...NOTHING, people_wait: this.peopleWait, ...what };
		const asking = request<Tried>('POST', `${ADDRESS}/${id}/advance`, { body, signal: AbortSignal.timeout(PATIENCE) });
		this.#under = asking.then(() => undefined);
		const answer = await asking;
		if (asked !== this.#asked || this.#closed) return false;
		this.pending = false;
		if (!answer.ok && answer.refusal.kind === 'no-simulation') {
			await this.begin({ present: this.values });
			this.forgotten = true;
			return this.told?.id === id ? false : this.#advance({ ...what, at: null });
		}
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return false;
		// Who has looked back meanwhile goes on looking there.
		this.#take(answer.value, body.at !== null || this.isAtHead ? answer.value.seconds : this.at);
		return answer.value.obstacle === null && (answer.value.stopped === null || answer.value.stopped === 'late');
	}

	#take(told: Tried, at: number): void {
		const kept = told.since < this.head ? this.moments.slice(0, countAt(this.moments, told.since)) : this.moments;
		const chapters = this.chapters.filter(({ seconds }) => seconds <= told.since);
		const isNew = told.model && { index: kept.length, seconds: told.since, number: told.number, model: told.model };
		this.chapters = isNew ? [...chapters, isNew] : chapters;
		this.moments = [...kept, ...told.moments];
		this.told = told;
		this.at = at;
	}
}
