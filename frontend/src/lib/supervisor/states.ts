/** How many states a station can reach, in words. */
import type { Analysis } from '#lib/contract.ts';

/** `22 512`; what JSON numbers cannot hold exactly is `about 4.2 × 10^28`. */
export function countText(states: number): string {
	if (Number.isSafeInteger(states)) return String(states).replace(/\B(?=(\d{3})+$)/g, '\u202f');
	const [digits = '', exponent = ''] = states.toExponential(1).split('e+');
	return `about ${digits} × 10^${exponent}`;
}

/** What is known of the states by now; nothing before anything is. */
export function statesText(analysis: Analysis): string {
	const { supervised, reachable_states: reachable, supervised_states: allowed } = analysis;
	if (supervised === false) return 'There is no supervisor, so nothing is started.';
	if (reachable === null) return '';
	const all = `${countText(reachable)} ${reachable === 1 ? 'state' : 'states'} can be reached`;
	return allowed === null ? `${all}.` : `${all}, ${countText(allowed)} of them with the supervisor.`;
}
