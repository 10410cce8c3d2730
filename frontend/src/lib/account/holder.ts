/** Who holds control, as who is signed in here sees it. */
import type { Control } from '#lib/contract.ts';

export type Holder = 'nobody' | 'you' | 'you-elsewhere' | 'another';

/** Whose `control` it is, for the session `session` of the person `person`. */
export function holderOf(control: Control | null, session: string | null, person: string | null): Holder {
	if (control === null) return 'nobody';
	if (control.session === session) return 'you';
	return control.person === person ? 'you-elsewhere' : 'another';
}

/** As it is said: `Operator A`, `you`, `you, elsewhere`, `nobody`. */
export function holderText(control: Control | null, holder: Holder): string {
	switch (holder) {
		case 'nobody':
			return 'nobody';
		case 'you':
			return 'you';
		case 'you-elsewhere':
			return 'you, in another browser';
		case 'another':
			return control?.name ?? '';
	}
}
