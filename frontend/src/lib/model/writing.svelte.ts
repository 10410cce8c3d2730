/**
 * What a person writes in one field, from the first sign to where it stands in the draft.
 *
 * What is typed stays until it is in the draft, or the person lets it go: a refusal takes nothing away, and where
 * somebody else has changed the same both can be seen. While nothing is typed the field shows what the draft says.
 */
import type { Refusal } from '#lib/rest/refusal.ts';

/** Milliseconds without a sign after which what was typed is sent. */
const PAUSE = 700;

/** Sends what `was` has become; why not, or null. */
export type Send<Value> = (was: Value, mine: Value) => Promise<Refusal | null>;

export interface Kept<Value> {
	/** What the draft says now. */
	read: () => Value;
	send: Send<Value>;
	equal: (one: Value, other: Value) => boolean;
	/** How the draft says what was typed, where that is written otherwise: without blanks around it. */
	normal?: (mine: Value) => Value;
	/** Why it cannot be sent as it is, in words; null where it can. */
	wrong?: (mine: Value) => string | null;
}

export class Writing<Value> {
	/** What it is about, for whoever looks for what was not written. */
	readonly label: string;
	readonly #kept: Kept<Value>;
	#mine = $state.raw<Value | undefined>();
	#base: Value | undefined;
	#stays = $state(false);
	/** Something was typed that is not in the draft. */
	dirty = $state(false);
	sending = $state(false);
	/** The last that was typed is in the draft. */
	accepted = $state(false);
	refusal = $state.raw<Refusal | null>(null);
	/** Somebody else has changed the same. */
	conflict = $state(false);
	#timer: ReturnType<typeof setTimeout> | undefined;
	#sent: Promise<void> | null = null;

	constructor(label: string, kept: Kept<Value>) {
		this.label = label;
		this.#kept = kept;
	}

	/** What the field shows: as it was typed, for as long as the draft says the same and the person is still there. */
	get shown(): Value {
		if (this.dirty) return this.#mine as Value;
		const said = this.#kept.read();
		if (!this.accepted || !this.#stays) return said;
		const mine = this.#mine as Value;
		return this.#kept.equal(this.#kept.normal?.(mine) ?? mine, said) ? mine : said;
	}

	/** What the draft says. */
	get theirs(): Value {
		return this.#kept.read();
	}

	/** Why what is typed is not sent, in words. */
	get wrong(): string | null {
		return this.dirty ? (this.#kept.wrong?.(this.#mine as Value) ?? null) : null;
	}

	/** Something was typed. */
	type(mine: Value): void {
		if (!this.dirty) this.#base = this.#kept.read();
		this.#mine = mine;
		this.#stays = true;
		this.dirty = true;
		this.accepted = false;
		this.refusal = null;
		clearTimeout(this.#timer);
		if (!this.conflict) this.#timer = setTimeout(() => void this.flush(), PAUSE);
	}

	/** Something was chosen: it is sent at once. */
	async choose(mine: Value): Promise<void> {
		this.type(mine);
		await this.flush();
	}

	/** The person has gone elsewhere. */
	async leave(): Promise<void> {
		this.#stays = false;
		await this.flush();
	}

	/** Sends what was typed, unless both versions wait for a choice. */
	async flush(): Promise<void> {
		clearTimeout(this.#timer);
		while (this.dirty && !this.conflict && this.wrong === null) {
			if (this.#sent !== null) {
				await this.#sent;
				if (this.refusal !== null) return;
				continue;
			}
			this.#sent = this.#send();
			await this.#sent;
			this.#sent = null;
			if (this.refusal !== null) return;
		}
	}

	/** Lets go what was typed. */
	drop(): void {
		clearTimeout(this.#timer);
		this.dirty = this.conflict = this.accepted = false;
		this.refusal = null;
	}

	/** Writes what was typed over what somebody else has written. */
	async insist(): Promise<void> {
		this.#base = this.#kept.read();
		this.conflict = false;
		await this.flush();
	}

	async #send(): Promise<void> {
		const was = this.#base as Value;
		const mine = this.#mine as Value;
		const { equal, read, send } = this.#kept;
		if (equal(was, mine) && equal(mine, read())) {
			if (this.#mine === mine) this.drop();
			return;
		}
		this.sending = true;
		this.refusal = null;
		const refusal = await send(was, mine);
		this.sending = false;
		if (refusal === null) {
			this.#base = mine;
			if (this.#mine !== mine) return; // typed on meanwhile: that is sent next
			this.dirty = false;
			this.accepted = true;
		} else {
			this.refusal = refusal;
			this.conflict = refusal.kind === 'part-changed' || !equal(was, read());
		}
	}
}
