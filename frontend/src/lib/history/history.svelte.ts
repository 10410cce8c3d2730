/** The past as the page shows it: the part of the time line in sight, and the moment that is chosen. */
import type { HistoryAnswer, Moment, Place, TimeLine } from '#lib/contract.ts';
import { actsOf, type Act } from '#lib/journal/acts.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { actsPage } from './records.svelte.ts';
import { USUAL, showing, within, type Window } from './window.ts';

/** Milliseconds for a look back: the first one also prepares the station. */
const PATIENCE = 70_000;

export class History {
	window = $state.raw<Window>({ from: Date.now() / 1000 - USUAL, to: Date.now() / 1000 });
	/** What happened in `lineWindow`; null before it is known. */
	line = $state.raw<TimeLine | null>(null);
	acts = $state.raw<readonly Act[]>([]);
	/** The line goes on with time. */
	follows = $state(true);
	/** The chosen record; null: nothing but now. */
	place = $state.raw<Place | null>(null);
	/** The act that was chosen, at the time of which the record stands. */
	act = $state.raw<Act | null>(null);
	/** How the station was at the last record that was chosen and read. */
	moment = $state.raw<Moment | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	momentRefusal = $state.raw<Refusal | null>(null);
	/** The moment is that of the chosen record. */
	readonly current = $derived(this.moment !== null && this.moment.record.number === this.place?.number);
	readonly #told: (place: Place | null) => void;
	#looking = false;
	#reading: Window | null = null;
	#again = false;
	#wish: { readonly time: number; readonly act: Act | null } | null = null;
	#wishing = false;

	/** `told` hears of each record that was chosen. */
	constructor(told: (place: Place | null) => void) {
		this.#told = told;
	}

	/** Reads the line in sight again; of several wishes meanwhile only the last one counts. */
	async look(): Promise<void> {
		if (this.#reading !== null) {
			this.#again = true;
			return;
		}
		do {
			this.#again = false;
			await this.#lookOnce();
		} while (this.#again);
	}

	async #lookOnce(): Promise<void> {
		const now = Date.now() / 1000;
		if (this.follows) this.window = { from: now - (this.window.to - this.window.from), to: now };
		const window = (this.#reading = this.window);
		const [answer, acts] = await Promise.all([
			request<TimeLine>('GET', `/api/v1/history/line?since=${window.from}&until=${window.to}`),
			actsPage(window.from, window.to, null)
		]);
		this.#reading = null;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		const { first, last } = answer.value;
		this.line = answer.value;
		this.acts = acts === null ? [] : actsOf(acts.records);
		if (this.follows && last.time < window.from) {
			this.follows = false;
			this.window = within({ from: last.time - USUAL, to: last.time }, first.time, last.time);
			this.#again = true;
		}
	}

	/** Shows another part of the line. */
	see(window: Window): void {
		const { first, last } = this.line ?? {};
		this.follows = false;
		this.window = first && last ? within(window, first.time, Math.max(last.time, Date.now() / 1000)) : window;
		void this.look();
	}

	/** Chooses a record. */
	async choose(number: number, act: Act | null = null): Promise<void> {
		const known = this.line;
		const wanted = known === null ? number : Math.min(Math.max(number, known.first.number), Math.max(known.last.number, number));
		this.act = act;
		this.place = { number: wanted, time: this.place?.time ?? this.window.to };
		const answer = await request<HistoryAnswer>('GET', `/api/v1/history?before=${wanted + 1}&limit=1`);
		if (this.place?.number !== wanted) return;
		if (!answer.ok) {
			this.momentRefusal = answer.refusal;
			return;
		}
		const [record] = answer.value.records;
		if (record !== undefined) this.#stand({ number: record.number, time: record.time });
	}

	/** Chooses the record at a time; of several wishes meanwhile only the last one counts. */
	async chooseAt(time: number, act: Act | null = null): Promise<void> {
		this.#wish = { time, act };
		if (this.#wishing) return;
		this.#wishing = true;
		for (let wish = this.#take(); wish !== null; wish = this.#take()) await this.#chooseAt(wish.time, wish.act);
		this.#wishing = false;
	}

	#take(): { readonly time: number; readonly act: Act | null } | null {
		const wish = this.#wish;
		this.#wish = null;
		return wish;
	}

	async #chooseAt(time: number, act: Act | null): Promise<void> {
		const answer = await request<Place>('GET', `/api/v1/history/at?time=${time}`);
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		this.act = act;
		this.#stand(answer.value);
	}

	/** Goes so many records on. */
	step(by: number): void {
		const from = this.place?.number ?? this.line?.last.number;
		if (from === undefined || this.line === null) return;
		void this.choose(Math.min(Math.max(from + by, this.line.first.number), this.line.last.number));
	}

	/** Back to now. */
	leave(): void {
		this.place = this.act = this.moment = this.momentRefusal = null;
		this.follows = true;
		this.#told(null);
		void this.look();
	}

	#stand(place: Place): void {
		this.place = place;
		const seen = showing(this.window, place.time);
		if (seen !== this.window || this.follows) this.see(seen);
		this.#told(place);
		void this.#lookBack();
	}

	/** Reads how the station was: one question at a time, and none for what was passed by meanwhile. */
	async #lookBack(): Promise<void> {
		if (this.#looking) return;
		this.#looking = true;
		let number = this.place?.number;
		while (number !== undefined && this.moment?.record.number !== number) {
			const answer = await request<Moment>('GET', `/api/v1/history/${number}`, { patience: PATIENCE });
			const wanted: number | undefined = this.place?.number;
			if (answer.ok && wanted !== undefined) this.moment = answer.value;
			if (wanted === number) {
				this.momentRefusal = answer.ok ? null : answer.refusal;
				break;
			}
			number = wanted;
		}
		this.#looking = false;
	}
}

