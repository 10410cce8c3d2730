/** How far a deployment has come, as it shows in what is heard of the station. */
import type { DeploymentOutcome, StationView } from '#lib/contract.ts';

export const PHASES = ['sent', 'accepted', 'anew', 'runs'] as const;
/** In the end the station runs it, or it could not be started and was undone. */
export type Phase = (typeof PHASES)[number] | 'undone';

export interface Heard {
	/** Whether the controller is heard. */
	readonly live: boolean;
	readonly production: StationView['production'] | null;
	/** Its ticks since it began. */
	readonly tick: number;
	/** What it says of this deployment; null while it began with none. */
	readonly state: DeploymentOutcome['state'] | null;
}

/** Where it is once `heard`, with the controller that was to end at tick `before`. */
export function follow(phase: Phase, heard: Heard, before: number): Phase {
	const begins = !heard.live || heard.production === 'preparing' || heard.production === null;
	const starting = begins || heard.state === 'starting';
	if (phase === 'accepted') return starting || heard.tick < before ? 'anew' : 'accepted';
	if (phase !== 'anew' || starting) return phase;
	return heard.state === 'undone' ? 'undone' : 'runs';
}
