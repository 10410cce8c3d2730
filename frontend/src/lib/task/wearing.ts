/** Whether this device is a watch of the station, and what each answer of the server makes of that. */
import type { WatchSelf } from '#lib/contract.ts';
import type { Answer } from '#lib/rest/request.ts';
import { say } from '#lib/text/text.svelte.ts';

/** Why a device is a watch no longer: in few words for a small face, and in full. */
export interface Lost {
	readonly title: string;
	readonly detail: string;
}

export type Wearing =
	/** It is none; `lost` says why, where it was one. */
	| { readonly kind: 'none'; readonly lost: Lost | null }
	/** The code was taken; an operator must confirm that this is the device that was meant. */
	| { readonly kind: 'waiting'; readonly self: WatchSelf }
	| { readonly kind: 'active'; readonly self: WatchSelf };

function ended(name: string): Lost {
	return { title: say().watch.pairing.ended, detail: say().watch.pairing.endedWhy(name) };
}

function unconfirmed(name: string): Lost {
	return { title: say().watch.pairing.unconfirmed, detail: say().watch.pairing.unconfirmedWhy(name) };
}

/** What a watch is that the server tells of; `before` names the watch that this device was when it was last used. */
export function wearingOf(self: WatchSelf | null, before: string | null): Wearing {
	if (self?.state === 'waiting' || self?.state === 'active') return { kind: self.state, self };
	return { kind: 'none', lost: before === null ? null : ended(before) };
}

/** What is known after the server was asked what this device is. Where it is not reached nothing changes. */
export function after(wearing: Wearing, answer: Answer<WatchSelf>): Wearing {
	if (answer.ok) return wearingOf(answer.value, answer.value.name);
	if (answer.refusal.status !== 401) return wearing;
	switch (wearing.kind) {
		case 'none':
			return wearing;
		case 'waiting':
			return { kind: 'none', lost: unconfirmed(wearing.self.name) };
		case 'active':
			return { kind: 'none', lost: ended(wearing.self.name) };
	}
}

/** Digits of a pairing code. */
export const CODE_LENGTH = 8;

/** The digits in what was typed, as far as a code has them. */
export function digitsOf(typed: string): string {
	return typed.replace(/\D/g, '').slice(0, CODE_LENGTH);
}

/** A code in two groups, as it is read out. */
export function grouped(code: string): string {
	return code.length > CODE_LENGTH / 2 ? `${code.slice(0, CODE_LENGTH / 2)} ${code.slice(CODE_LENGTH / 2)}` : code;
}
