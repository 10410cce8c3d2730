/** A question that a person has opened: whether to set an alarm aside, as it was shown then. */
import type { Alarm } from '#lib/contract.ts';

export interface Asked {
	/** For some time, or until it is put back in service. */
	readonly kind: 'shelve' | 'suppress';
	readonly key: string;
	readonly alarm: Alarm;
}
