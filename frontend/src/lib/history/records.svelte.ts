/** The list as the page knows it: from a place of the journal on, older ones page by page as they are wanted. */
import type { Actor, AuditAnswer, AuditRecord, HistoryAnswer, Place, RunRecord, StationView } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { NOTHING, UNREAD, boundOf, joined, meets, readOf, rowsOf, type Read } from './rows.ts';
import { EVERYTHING_OF_NOTE, isAct, questionOf, wantsActs, type Sought } from './sought.ts';

const PAGE = 100;
const ACTS = 200;
/** Rows after which a person may look on, and pages that are read for them at most. */
const FEW = 20;
const MOST_PAGES = 20;
/** Seconds after a record that was chosen elsewhere, of which acts are shown too. */
const LATER = 1;
/** Records above one that was chosen elsewhere. */
const ABOVE = 4;

export class Records {
	sought = $state.raw<Sought>(EVERYTHING_OF_NOTE);
	/** Where the list begins; null: with the newest. */
	from = $state.raw<Place | null>(null);
	pending = $state(false);
	refusal = $state.raw<Refusal | null>(null);
	/** Everybody who was met so far, by id. */
	actors = $state.raw<ReadonlyMap<string, Actor>>(new Map());
	#records = $state.raw<Read<RunRecord>>(UNREAD);
	#acts = $state.raw<Read<AuditRecord>>(UNREAD);
	/** What is older than this is not known whole yet: of one of both there may be more. */
	readonly #known = $derived(Math.max(boundOf(this.#records), boundOf(this.#acts)));
	readonly rows = $derived(
		rowsOf(this.#records.all, this.#acts.all.filter((each) => isAct(each, this.sought, this.#view()))).filter(
			({ time }) => time >= this.#known
		)
	);
	/** There is something older. */
	readonly more = $derived(this.#records.more || this.#acts.more);
	readonly #view: () => StationView | null;
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
		this.#records = questionOf(sought, null) === null ? NOTHING : UNREAD;
		this.#acts = wantsActs(sought) ? UNREAD : NOTHING;
		this.pending = false;
		await this.older();
	}

	/** Reads what is new, where the list begins with the newest. */
	async newest(): Promise<void> {
		if (this.from !== null || this.pending) return;
		const asked = this.#asked;
		const [records, acts] = await Promise.all([
			this.#records === NOTHING ? NOTHING : this.#readRecords(null),
			this.#acts === NOTHING ? NOTHING : this.#readActs(null)
		]);
		if (asked !== this.#asked || this.pending || records === null || acts === null) return;
		if (!meets(this.#records, records) || !meets(this.#acts, acts)) return void (await this.show(this.sought, null));
		this.#records = { ...this.#records, all: joined(this.#records.all, records.all) };
		this.#acts = { ...this.#acts, all: joined(this.#acts.all, acts.all) };
	}

	/** Sees to it that what was read reaches to a record: else the list begins with it. */
	async reach(place: Place): Promise<void> {
		const above = this.from !== null && place.number > this.from.number + ABOVE;
		if (above || (this.more && place.time < this.#known)) await this.show(this.sought, place);
	}

	/** Reads on until there is a row more, or nothing older. */
	async older(): Promise<void> {
		if (this.pending) return;
		const asked = this.#asked;
		const before = this.rows.length;
		this.pending = true;
		for (let pages = 0; pages < MOST_PAGES && this.more && this.rows.length < before + FEW; pages++) {
			// The one that is known the shorter way back keeps the other from being shown.
			const ofRecords = this.#records.more && boundOf(this.#records) >= boundOf(this.#acts);
			const known: Read<RunRecord | AuditRecord> = ofRecords ? this.#records : this.#acts;
			const read = ofRecords ? await this.#readRecords(known.next) : await this.#readActs(known.next);
			if (asked !== this.#asked) return;
			if (read === null) break;
			if (ofRecords) this.#records = { ...read, all: joined(this.#records.all, read.all as RunRecord[]) } as Read<RunRecord>;
			else this.#acts = { ...read, all: joined(this.#acts.all, read.all as AuditRecord[]) } as Read<AuditRecord>;
		}
		this.pending = false;
	}

	async #readRecords(next: number | null): Promise<Read<RunRecord> | null> {
		const query = questionOf(this.sought, this.#view()) ?? new URLSearchParams();
		const before = next ?? (this.from === null ? null : this.from.number + 1 + ABOVE);
		query.set('limit', String(PAGE));
		if (before !== null) query.set('before', String(before));
		const answer = await request<HistoryAnswer>('GET', `/api/v1/history?${query}`);
		this.refusal = answer.ok ? null : answer.refusal;
		return answer.ok ? readOf(answer.value) : null;
	}

	async #readActs(next: number | null): Promise<Read<AuditRecord> | null> {
		const until = this.from === null ? null : this.from.time + LATER;
		const page = await actsPage(null, until, next, this.sought.who?.id ?? null);
		if (page === null) return null;
		if (page.records.some(({ entry }) => !this.actors.has(entry.actor.id))) {
			const met = page.records.map(({ entry }) => [entry.actor.id, entry.actor] as const);
			this.actors = new Map([...this.actors, ...met]);
		}
		return readOf(page);
	}
}

/** A page of what people did from `since` to before `until`; null where it could not be read. */
export async function actsPage(
	since: number | null,
	until: number | null,
	before: number | null = null,
	actor: string | null = null
): Promise<AuditAnswer | null> {
	const query = new URLSearchParams({ limit: String(ACTS) });
	for (const [name, value] of Object.entries({ since, until, before, actor }))
		if (value !== null) query.set(name, String(value));
	const answer = await request<AuditAnswer>('GET', `/api/v1/audit?${query}`);
	return answer.ok ? answer.value : null;
}
