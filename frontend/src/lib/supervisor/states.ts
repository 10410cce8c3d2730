/** How many states a station can reach, in words. */
import type { Analysis } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** `22 512`; what JSON numbers cannot hold exactly is `about 4.2 × 10^28`. */
export function countText(states: number): string {
	if (Number.isSafeInteger(states)) return String(states).replace(/\B(?=(\d{3})+$)/g, '\u202f');
	const [digits = '', exponent = ''] = states.toExponential(1).split('e+');
	return say().operate.supervisor.about(`${digits} × 10^${exponent}`);
}

/** What is known of the states by now; nothing before anything is. */
export function statesText(analysis: Analysis): string {
	const { supervised, reachable_states: reachable, supervised_states: allowed, supervised_at_most: most } = analysis;
	if (supervised === false) return say().operate.supervisor.none;
	const { reached, supervised: some, atMost } = say().operate.supervisor;
	const limit = most === null ? '' : `${atMost(countText(most))}.`;
	if (reachable === null) return limit;
	const all = reached(countText(reachable), reachable === 1);
	return allowed === null ? `${all}. ${limit}`.trim() : `${all}, ${some(countText(allowed))}.`;
}
