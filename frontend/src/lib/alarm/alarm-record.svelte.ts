/** The alarms of some time past as this page knows them, read from the journal. */
import type { HistoryAnswer } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { past, reachesTo, turnsOf, withNewest, withOlder } from './record.ts';

/** Alarms that are over, shown at once, and again with each press. */
const STEP = 20;
/** Pages that are read without being asked for again: where alarms come in thousands, the figures say `at least`. */
const PAGES = 5;
export const HOUR = 3600;

export class AlarmRecord {
	#known = $state.raw<HistoryAnswer | null>(null);
	#shown = $state(STEP);
	#reading = false;
	refusal = $state.raw<Refusal | null>(null);
	/** Older records are on their way. */
	pending = $state(false);

	/** All turns that are known, the newest first; null before the first answer. */
	readonly turns = $derived(this.#known === null ? null : turnsOf(this.#known.records));
	readonly #past = $derived(past(this.turns ?? []));
	/** The alarms that are over, the newest first, as many as are shown. */
	readonly earlier = $derived(this.#past.slice(0, this.#shown));
	readonly more: boolean = $derived(this.#past.length > this.#shown || (this.#known?.next ?? null) !== null);

	/** Whether everything since `from` is known. */
	reachesTo(from: number): boolean {
		return this.#known !== null && reachesTo(this.#known, from);
	}

	/** Reads the newest records, and as far back as the figures of the last hour need, at the controller's time `now`. */
	async newest(now: number): Promise<void> {
		if (this.#reading) return;
		this.#reading = true;
		const answer = await this.#read(null, 50);
		if (answer !== null) this.#known = withNewest(this.#known, answer);
		for (let page = 0; answer !== null && page < PAGES && !this.reachesTo(now - HOUR); page++)
			if (!(await this.#goBack())) break;
		this.#reading = false;
	}

	/** Shows some more of those that are over, and reads them if need be. */
	async older(): Promise<void> {
		if (this.pending) return;
		this.pending = true;
		const wanted = this.#past.length >= this.#shown + STEP ? this.#shown + STEP : this.#past.length + STEP;
		for (let page = 0; page < PAGES && this.#past.length < wanted; page++) if (!(await this.#goBack())) break;
		this.#shown = wanted;
		this.pending = false;
	}

	/** Reads what is not known yet since `from`, as far as there is not too much. */
	async backTo(from: number): Promise<void> {
		if (this.pending) return;
		this.pending = true;
		for (let page = 0; page < PAGES && !this.reachesTo(from); page++) if (!(await this.#goBack())) break;
		this.pending = false;
	}

	/** Reads one page more; false where there is none, or it was refused. */
	async #goBack(): Promise<boolean> {
		const from = this.#known?.next ?? null;
		if (from === null) return false;
		const answer = await this.#read(from, 200);
		if (answer === null || this.#known?.next !== from) return false;
		this.#known = withOlder(this.#known, answer);
		return true;
	}

	async #read(before: number | null, limit: number): Promise<HistoryAnswer | null> {
		const query = new URLSearchParams({ kinds: 'alarm', limit: String(limit) });
		if (before !== null) query.set('before', String(before));
		const answer = await request<HistoryAnswer>('GET', `/api/v1/history?${query}`);
		this.refusal = answer.ok ? null : answer.refusal;
		return answer.ok ? answer.value : null;
	}
}
