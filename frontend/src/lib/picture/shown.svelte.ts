/**
 * The picture of the draft as it is drawn, and what is done to it: a drop counts at once, and is drawn so until the station
 * has drawn it anew.
 */
import type { DraftPicture, Mimic } from '#lib/contract.ts';
import { askedOf } from '#lib/examples/address.ts';
import type { Draft } from '#lib/model/draft.svelte.ts';
import { PICTURE } from '#lib/model/tree.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request } from '#lib/rest/request.ts';
import { editsOf, shiftedPicture, shiftedThing, thingsOf, type Shift, type Thing } from './things.ts';

/** Milliseconds in which the picture of a large model is drawn. */
const PATIENCE = 20_000;

/** A thing as it was, and what is done to it. */
export interface Moved {
	readonly thing: Thing;
	readonly shift: Shift;
}

export class ShownPicture {
	readonly #draft: Draft;
	/** The last that could be drawn. */
	told = $state.raw<DraftPicture | null>(null);
	/** The model could be used when it was asked for last. */
	usable = $state(true);
	refusal = $state.raw<Refusal | null>(null);
	/** What is being dragged. */
	dragged = $state.raw<Moved | null>(null);
	/** What is on its way to the draft. */
	#sent = $state.raw<readonly Moved[]>([]);
	/** What is in the draft, and not yet drawn. */
	#made = $state.raw<readonly Moved[]>([]);
	#asked = 0;
	#before: Promise<unknown> = Promise.resolve();

	constructor(draft: Draft) {
		this.#draft = draft;
	}

	/** The digest of the file as it is; null where there is none. */
	readonly digest = $derived.by(() => this.#draft.files[PICTURE]?.digest ?? null);

	/** The file is there, and drawn. */
	readonly isDrawn = $derived(this.digest !== null && this.told?.picture?.made_from === 'file');

	/** The things of the file, with all that is done to them. */
	readonly things: readonly Thing[] = $derived.by(() => {
		const found = this.isDrawn ? thingsOf(this.#draft.contents[PICTURE], this.told?.picture ?? null) : [];
		const done = [...this.#sent, ...(this.dragged ? [this.dragged] : [])];
		return done.reduce<Thing[]>((things, { shift }) => things.map((thing) => shiftedThing(thing, shift)), found);
	});

	readonly picture: Mimic | null = $derived.by(() => {
		const done = [...this.#made, ...this.#sent, ...(this.dragged ? [this.dragged] : [])];
		const drawn = this.told?.picture ?? null;
		return drawn && done.reduce((picture, { thing, shift }) => shiftedPicture(picture, thing, shift), drawn);
	});

	/** Asks for it. One of another file than the page knows is left: its news is on its way. */
	async again(): Promise<void> {
		const asked = ++this.#asked;
		const answer = await request<DraftPicture>('GET', askedOf('/api/v1/model/mimic', this.#draft.example), { patience: PATIENCE });
		if (asked !== this.#asked) return;
		this.refusal = answer.ok ? null : answer.refusal;
		if (!answer.ok) return;
		this.usable = answer.value.usable;
		if (answer.value.picture === null || (this.told !== null && answer.value.digest !== this.digest)) return;
		this.told = answer.value;
		this.#made = [];
	}

	/** Carries out what was dragged, as one change of the draft; why not, or null. */
	drop(title: (shift: Shift) => string): Promise<Refusal | null> {
		const { dragged } = this;
		this.dragged = null;
		if (dragged === null || !moves(dragged.shift)) return Promise.resolve(null);
		this.#sent = [...this.#sent, dragged];
		const sending = this.#before.then(async () => {
			const { thing, shift } = dragged;
			const refusal = await this.#draft.change(title(shift), editsOf(this.#draft.contents[PICTURE], thing, shift));
			this.#sent = this.#sent.filter((each) => each !== dragged);
			if (refusal === null) this.#made = [...this.#made, dragged];
			return refusal;
		});
		this.#before = sending;
		return sending;
	}
}

const moves = ({ dx, dy, wider, higher }: Shift): boolean => [dx, dy, wider, higher].some((each) => each !== 0);
