/** Who holds control, as who is signed in here sees it. */
import type { Control } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

export type Holder = 'nobody' | 'you' | 'you-elsewhere' | 'another';

/** Whose `control` it is, for the session `session` of the person `person`. */
export function holderOf(control: Control | null, session: string | null, person: string | null): Holder {
	if (control === null) return 'nobody';
	if (control.session === session) return 'you';
	return control.person === person ? 'you-elsewhere' : 'another';
}

/** The same as a sentence of the bar. */
export function heldText(control: Control | null, holder: Holder): string {
	const words = say().account.control;
	if (holder === 'nobody') return words.free;
	if (holder === 'you') return words.mine;
	return holder === 'you-elsewhere' ? words.mineElsewhere : words.held(holderText(control, holder));
}

/** As it is said: `Operator A`, `you`, `you, elsewhere`, `nobody`. */
export function holderText(control: Control | null, holder: Holder): string {
	switch (holder) {
		case 'nobody':
			return say().account.control.nobody;
		case 'you':
			return say().account.control.you;
		case 'you-elsewhere':
			return say().account.control.elsewhere;
		case 'another':
			return control?.name ?? '';
	}
}
