/** The list as the page knows it: from a place of the journal on, older ones page by page as they are wanted. */
import type { Actor, AuditAnswer, AuditRecord, HistoryAnswer, Place, RunRecord, StationView } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { joined, rowsOf } from './rows.ts';
import { EVERYTHING_OF_NOTE, isAct, questionOf, type Sought } from './sought.ts';

const PAGE = 100;
const ACTS = 200;
/** Records above one that was chosen elsewhere. */
const ABOVE = 4;

export class Records {
	sought = $state.raw<Sought>(EVERYTHING_OF_NOTE);
	/** Where the list begins; null: with the newest. */
	from = $state.raw<Place | null>(null);
	pending = $state(false);
	refusal = $state.raw<Refusal | null>(null);
	/** There is something older. */
	more = $state(true);
	/** Everybody who was met so far, by id. */
	actors = $state.raw<ReadonlyMap<string, Actor>>(new Map());
	#records = $state.raw<readonly RunRecord[]>([]);
	#acts = $state.raw<readonly AuditRecord[]>([]);
	readonly rows = $derived(rowsOf(this.#records, this.#acts));
	readonly #view: () => StationView | null;
	#next: number | null = null;
	/** The end of the time of which acts are not read yet. */
	#until: number | null = null;
	/** Counted up whenever what is on its way is not wanted any more. */
	#asked = 0;

	constructor(view: () => StationView | null) {
		this.#view = view;
	}

	/** Shows what is sought, from `from` on. */
	async show(sought: Sought, from: Place | null): Promise<void> {
		this.#asked++;
		this.sought = sought;
		this.from = from;
		this.#next = from === null ? null : from.number + 1 + ABOVE;
		this.#until = null;
		this.pending = false;
		this.more = true;
		await this.#page(true);
	}

	/** Sees to it that what was read reaches to a record: else the list begins with it. */
	async reach(place: Place): Promise<void> {
		const oldest = this.#records.at(-1)?.number ?? Infinity;
		const above = this.from !== null && place.number > this.from.number + ABOVE;
		if (above || (this.more && place.number < oldest)) await this.show(this.sought, place);
	}

	/** Reads the next older page. */
	async older(): Promise<void> {
		if (this.more && !this.pending) await this.#page(false);
	}

	/** Reads what is new, where the list begins with the newest. */
	async newest(): Promise<void> {
		if (this.from !== null || this.pending) return;
		const asked = this.#asked;
		const query = questionOf(this.sought, this.#view());
		const since = this.rows[0]?.time;
		const page = query === null ? null : await this.#read(query, null);
		const acts = await this.#actsBetween(since ?? null, null);
		if (asked !== this.#asked || acts === null) return;
		if (page !== null) {
			const known = new Set(this.#records.map((each) => each.number));
			const meets = page.next === null || page.records.some((each) => known.has(each.number));
			if (!meets) return void (await this.show(this.sought, null));
			this.#records = joined(this.#records, page.records);
		}
		this.#acts = joined(this.#acts, acts);
	}

	async #page(anew: boolean): Promise<void> {
		const asked = this.#asked;
		this.pending = true;
		const query = questionOf(this.sought, this.#view());
		const page = query === null ? { records: [], next: null } : await this.#read(query, this.#next);
		const until = this.#until ?? (page?.records[0] && this.from !== null ? page.records[0].time + 1 : null);
		const since = page?.next == null ? null : (page.records.at(-1)?.time ?? null);
		const acts = page === null ? null : await this.#actsBetween(since, until);
		if (asked !== this.#asked) return;
		this.pending = false;
		if (page === null || acts === null) return;
		this.#records = anew ? page.records : joined(this.#records, page.records);
		this.#acts = anew ? acts : joined(this.#acts, acts);
		this.#next = page.next;
		this.#until = since;
		this.more = page.next !== null;
	}

	async #read(query: URLSearchParams, before: number | null): Promise<HistoryAnswer | null> {
		const asked = new URLSearchParams(query);
		asked.set('limit', String(PAGE));
		if (before !== null) asked.set('before', String(before));
		const answer = await request<HistoryAnswer>('GET', `/api/v1/history?${asked}`);
		this.refusal = answer.ok ? null : answer.refusal;
		return answer.ok ? answer.value : null;
	}

	/** All acts from `since` to before `until` that are sought. */
	async #actsBetween(since: number | null, until: number | null): Promise<AuditRecord[] | null> {
		const found: AuditRecord[] = [];
		if (!['note', 'people', 'every'].includes(this.sought.kind)) return found;
		let next: number | null = null;
		do {
			const read: AuditAnswer | null = await actsPage(since, until, next);
			if (read === null) return null;
			found.push(...read.records);
			next = read.next;
		} while (next !== null);
		if (found.some(({ entry }) => !this.actors.has(entry.actor.id)))
			this.actors = new Map([...this.actors, ...found.map(({ entry }) => [entry.actor.id, entry.actor] as const)]);
		return found.filter((each) => isAct(each, this.sought, this.#view()));
	}
}

/** A page of what people did from `since` to before `until`; null where it could not be read. */
export async function actsPage(
	since: number | null,
	until: number | null,
	before: number | null
): Promise<AuditAnswer | null> {
	const query = new URLSearchParams({ limit: String(ACTS) });
	if (since !== null) query.set('since', String(since));
	if (until !== null) query.set('until', String(until));
	if (before !== null) query.set('before', String(before));
	const answer = await request<AuditAnswer>('GET', `/api/v1/audit?${query}`);
	return answer.ok ? answer.value : null;
}
