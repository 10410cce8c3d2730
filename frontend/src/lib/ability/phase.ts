/** Where an ability is in its automaton. */
import type { Ability } from '#lib/contract.ts';

export type Phase = 'unknown' | 'idle' | 'enabled' | 'started' | 'executing' | 'finished';

type Flags = Pick<Ability, 'enabled' | 'executing' | 'finished' | 'running_since'>;

/**
 * The state to show. Its flags are truths of their own, and several can be so at once: what runs counts before what is
 * over, and that before what could begin. One that was started and is not seen executing yet is `started`.
 */
export function phaseOf({ enabled, executing, finished, running_since: since }: Flags): Phase {
	if (executing === true) return 'executing';
	if (since !== null) return 'started';
	if (finished === true) return 'finished';
	if (enabled === true) return 'enabled';
	return enabled === null || executing === null || finished === null ? 'unknown' : 'idle';
}
