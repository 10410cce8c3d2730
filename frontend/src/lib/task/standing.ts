/** What somebody who is asked for something has to know of the station first. */
import type { Standing } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** How much of somebody's attention it wants. */
export type Tone = 'plain' | 'medium' | 'high';

/** Why nothing starts by itself, whatever is said of a task; empty where the station goes on. */
export function whyItStands(standing: Standing): string {
	return standing === 'working' || standing === 'silent' ? '' : say().watch.standing[standing];
}

/** What is not as it should be: why the station stands, or which devices it does not hear, or which of the others do not work. */
export function stateText(standing: Standing, silent: readonly string[], failing: readonly string[]): string {
	if (whyItStands(standing)) return whyItStands(standing);
	if (silent.length > 0) return say().watch.silent(silent.join(', '));
	return failing.length > 0 ? say().watch.failing(failing.join(', ')) : '';
}

/** How much attention that wants: somebody's help, or that one keeps clear. */
export function toneOf(standing: Standing, silent: readonly string[], failing: readonly string[]): Tone {
	if (standing === 'held' || standing === 'restart') return 'medium';
	if (standing === 'stopped') return 'high';
	return whyItStands(standing) === '' && silent.length + failing.length > 0 ? 'high' : 'plain';
}
