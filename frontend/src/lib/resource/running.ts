/** What is under way. */
import type { Ability } from '#lib/contract.ts';

/** Whether it runs: it was started here, or is seen to execute, as one that was started by a controller before. */
export function runs(ability: Ability): boolean {
	return ability.running_since !== null || ability.executing === true;
}
