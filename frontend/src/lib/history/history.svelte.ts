/** The past as the page shows it: the part of the time line in sight, and the moment that is chosen. */
import type { HistoryAnswer, Moment, Place, TimeLine } from '#lib/contract.ts';
import { actsOf, type Act } from '#lib/journal/acts.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { say } from '#lib/text/text.svelte.ts';
import { actsPage } from './records.svelte.ts';
import { USUAL, showing, within, type Window } from '#lib/axis/window.ts';

/** Milliseconds for a look back: the first one also prepares the station. */
const PATIENCE = 70_000;
/** Milliseconds for a record or a place of the line, also where the machine is busy. */
const SOON = 20_000;

/** Seconds of a record of which not all is shown at once, and of a day. */
const LONG = 12 * 3600;
const DAY = 24 * 3600;
/** Seconds for which the line goes on to now although nothing comes. */
const QUIET = 3600;

/** What a person wants to see: a record by its number, or the one at a time. */
interface Wish {
	readonly number: number | null;
	readonly time: number | null;
	readonly act: Act | null;
}

/** Nothing is recorded yet of what was asked for, as while a station begins. */
function notThere(): Refusal {
	const { title, detail } = say().history.notThere;
	return { title, detail, status: null, kind: null, retryAfter: null, place: null };
}

function placeOf(answer: HistoryAnswer | Place): Place | null {
	if (!('records' in answer)) return answer;
	const [record] = answer.records;
	return record === undefined ? null : { number: record.number, time: record.time };
}

export class History {
	window = $state.raw<Window>({ from: Date.now() / 1000 - USUAL, to: Date.now() / 1000 });
	/** What happened in `lineWindow`; null before it is known. */
	line = $state.raw<TimeLine | null>(null);
	acts = $state.raw<readonly Act[]>([]);
	/** The whole of the record, or of the day where that is long; null before it is known. */
	overview = $state.raw<{ readonly window: Window; readonly line: TimeLine } | null>(null);
	/** The line goes on with time. */
	follows = $state(true);
	/** The chosen record; null: nothing but now. */
	place = $state.raw<Place | null>(null);
	/** The act that was chosen, at the time of which the record stands. */
	act = $state.raw<Act | null>(null);
	/** How the station was at the last record that was chosen and read. */
	moment = $state.raw<Moment | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	/** Why what was chosen could not be found; it stays until something else is chosen. */
	choiceRefusal = $state.raw<Refusal | null>(null);
	momentRefusal = $state.raw<Refusal | null>(null);
	/** The moment is that of the chosen record. */
	readonly current = $derived(this.moment !== null && this.moment.record.number === this.place?.number);
	readonly #told: (place: Place | null) => void;
	#looking = false;
	#reading: Window | null = null;
	#again = false;
	#wish: Wish | null = null;
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
			actsPage(window.from, window.to)
		]);
		this.#reading = null;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		const { first, last } = answer.value;
		this.line = answer.value;
		this.acts = acts === null ? [] : actsOf(acts.records);
		if (this.follows && last.time < window.from) {
			// Of what was lately it is seen how long nothing has come since; what is long ago is looked at by itself.
			this.follows = now - last.time < QUIET;
			this.window = this.follows ? { from: Math.max(first.time, last.time - USUAL), to: now } : within({ from: last.time - USUAL, to: last.time }, first.time, last.time);
			this.#again = true;
		}
	}

	/** Reads how much happened all the time, or on the day of what is in sight where that is long. */
	async lookOver(): Promise<void> {
		const { first, last } = this.line ?? {};
		if (first === undefined || last === undefined) return;
		const now = Math.max(last.time, this.follows ? Date.now() / 1000 : last.time);
		const midnight = new Date(((this.window.from + this.window.to) / 2) * 1000).setHours(0, 0, 0, 0) / 1000;
		const short = now - first.time <= LONG;
		const from = short ? first.time : Math.max(midnight, first.time);
		const to = short ? now : Math.min(midnight + DAY, now);
		if (to <= from) return;
		const answer = await request<TimeLine>('GET', `/api/v1/history/line?since=${from}&until=${to}`, { patience: SOON });
		if (answer.ok) this.overview = { window: { from, to }, line: answer.value };
	}

	/** Shows a part of this length: that around the chosen moment, else the latest. */
	stretch(length: number): void {
		const { first, last } = this.line ?? {};
		if (!Number.isFinite(length)) {
			if (first && last) this.see({ from: first.time, to: Math.max(last.time, this.follows ? Date.now() / 1000 : last.time) });
			return;
		}
		if (this.place === null && this.follows) {
			this.window = { from: this.window.to - length, to: this.window.to };
			void this.look();
			return;
		}
		const middle = this.place?.time ?? (this.window.from + this.window.to) / 2;
		this.see({ from: middle - length / 2, to: middle + length / 2 });
	}

	/** Shows another part of the line. */
	see(window: Window): void {
		const { first, last } = this.line ?? {};
		this.follows = false;
		this.window = first && last ? within(window, first.time, Math.max(last.time, Date.now() / 1000)) : window;
		void this.look();
	}

	/** Chooses a record. */
	choose(number: number, act: Act | null = null): Promise<void> {
		return this.#want({ number, time: null, act });
	}

	/** Chooses the record at a time. */
	chooseAt(time: number, act: Act | null = null): Promise<void> {
		return this.#want({ number: null, time, act });
	}

	/** Follows the last wish; those that came between are not asked for. */
	async #want(wish: Wish): Promise<void> {
		this.#wish = wish;
		if (this.#wishing) return;
		this.#wishing = true;
		for (let last: Wish | null = null; this.#wish !== last; ) {
			last = this.#wish;
			if (last !== null) await this.#follow(last);
		}
		this.#wish = null;
		this.#wishing = false;
	}

	async #follow({ number, time, act }: Wish): Promise<void> {
		const answer =
			number === null
				? await request<Place>('GET', `/api/v1/history/at?time=${time}`, { patience: SOON })
				: await request<HistoryAnswer>('GET', `/api/v1/history?before=${number + 1}&limit=1`, { patience: SOON });
		const place = answer.ok ? placeOf(answer.value) : null;
		this.choiceRefusal = answer.ok ? (place === null ? notThere() : null) : answer.refusal;
		if (place === null || this.#wish === null) return;
		this.act = act;
		this.#stand(place);
	}

	/** Goes so many records on. */
	step(by: number): void {
		const from = this.#wish?.number ?? this.place?.number ?? this.line?.last.number;
		if (from === undefined || this.line === null) return;
		void this.choose(Math.min(Math.max(from + by, this.line.first.number), this.line.last.number));
	}

	/** Back to now. */
	leave(): void {
		this.#wish = this.place = this.act = this.moment = this.momentRefusal = null;
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

