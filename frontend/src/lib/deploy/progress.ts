/** How far a deployment has come, as it shows in what is heard of the station. */
import type { StationView } from '#lib/contract.ts';

export const PHASES = ['sent', 'accepted', 'anew', 'runs'] as const;
export type Phase = (typeof PHASES)[number];

export interface Heard {
	/** Whether the controller is heard. */
	readonly live: boolean;
	readonly production: StationView['production'] | null;
	/** Its ticks since it began. */
	readonly tick: number;
}

/** Where it is once `heard`, with the controller that was to end at tick `before`. */
export function follow(phase: Phase, heard: Heard, before: number): Phase {
	const begins = !heard.live || heard.production === 'preparing';
	if (phase === 'accepted') return begins || heard.tick < before ? 'anew' : 'accepted';
	if (phase === 'anew') return begins || heard.production === null ? 'anew' : 'runs';
	return phase;
}
