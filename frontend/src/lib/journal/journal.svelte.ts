/** The journal as this page knows it: the newest records, and older ones page by page. */
import type { Actor, AuditAnswer } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { withNewest, withOlder } from './acts.ts';

export interface Filter {
	/** The act, or empty for all. */
	readonly action: string;
	/** The id of who acts, or empty for all. */
	readonly actor: string;
}

export class Journal {
	known = $state.raw<AuditAnswer | null>(null);
	refusal = $state.raw<Refusal | null>(null);
	filter = $state.raw<Filter>({ action: '', actor: '' });
	/** Older records are on their way. */
	pending = $state(false);
	/** Everybody who was met in the journal so far, by id. */
	actors = $state.raw<ReadonlyMap<string, Actor>>(new Map());

	/** Reads the newest records. */
	async newest(): Promise<void> {
		const answer = await this.#read(null);
		if (answer !== null) this.known = withNewest(this.known, answer);
	}

	/** Reads the records before those that are known. */
	async older(): Promise<void> {
		const from = this.known?.next ?? null;
		if (from === null || this.pending) return;
		this.pending = true;
		const answer = await this.#read(from);
		this.pending = false;
		if (answer !== null && this.known?.next === from) this.known = withOlder(this.known, answer);
	}

	/** Shows only what `filter` lets through. */
	async narrow(filter: Filter): Promise<void> {
		this.filter = filter;
		this.known = null;
		await this.newest();
	}

	/** One page; null when it was refused, or is not asked for any more. */
	async #read(before: number | null): Promise<AuditAnswer | null> {
		const asked = this.filter;
		const query = new URLSearchParams();
		if (before !== null) query.set('before', String(before));
		if (asked.action !== '') query.set('action', asked.action);
		if (asked.actor !== '') query.set('actor', asked.actor);
		const answer = await request<AuditAnswer>('GET', `/api/v1/audit?${query}`);
		if (asked !== this.filter) return null;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return null;
		const met = answer.value.records.map((record) => [record.entry.actor.id, record.entry.actor] as const);
		if (met.some(([id]) => !this.actors.has(id))) this.actors = new Map([...met, ...this.actors]);
		return answer.value;
	}
}
