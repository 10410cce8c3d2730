/** What somebody who is asked for something has to know of the station first. */
import type { Alarm, Standing, WatchSnapshot } from '#lib/contract.ts';
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

/** What somebody does next, and in about how many seconds, as of `time`; empty where the plan has nothing. */
export function nextText(next: WatchSnapshot['next'] | undefined, time: number | null): string {
	if (!next) return '';
	return say().watch.next(next.title, next.at === null || time === null ? null : Math.max(0, Math.round(next.at - time)));
}

/**
 * The alarm to name where help is needed, as the server picks it for a paired watch: the most urgent, of equals what nobody has
 * seen, then the newest. What people have a problem with is between them and the operators; topics are nothing for a watch.
 */
export function namedAlarm(alarms: readonly Alarm[]): Alarm | undefined {
	const rank = ({ priority, state }: Alarm): number => (priority === 'high' ? 2 : 0) + (state === 'unacknowledged' ? 1 : 0);
	return alarms
		.filter(({ state, priority, group }) => /^(un)?acknowledged$/.test(state) && priority !== 'low' && group !== 'people' && group !== 'communication')
		.sort((a, b) => rank(b) - rank(a) || b.since - a.since)[0];
}
