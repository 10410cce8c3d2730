/** What somebody who is asked for something has to know of the station first. */
import type { Priority, Standing, StationView, WatchSnapshot } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';
import { listed } from '#lib/wording/listed.ts';

/** How much of somebody's attention it wants. */
export type Tone = 'plain' | 'medium' | 'high';

/** Why nothing starts by itself, whatever is said of a task; empty where the station goes on. */
export function whyItStands(standing: Standing): string {
	return standing === 'working' || standing === 'silent' ? '' : say().watch.standing[standing];
}

/** What is not as it should be: why the station stands, or which devices it does not hear, or which of the others do not work. */
export function stateText(standing: Standing, silent: readonly string[], failing: readonly string[]): string {
	if (whyItStands(standing)) return whyItStands(standing);
	if (silent.length > 0) return say().watch.silent(listed(silent));
	return failing.length > 0 ? say().watch.failing(listed(failing)) : '';
}

/** How much attention that wants: somebody's help, as urgently as the alarm of it says, or that one keeps clear. */
export function toneOf(standing: Standing, silent: readonly string[], failing: readonly string[], alarm?: Priority): Tone {
	if (standing === 'held' || standing === 'restart') return 'medium';
	if (standing === 'stopped') return toned(alarm) ?? 'high';
	return whyItStands(standing) === '' && silent.length + failing.length > 0 ? (toned(alarm) ?? 'medium') : 'plain';
}

function toned(priority: Priority | undefined): Tone | undefined {
	return priority === 'low' ? undefined : priority;
}

/** What somebody does next, and when, where that is known. */
export type Next = Pick<NonNullable<WatchSnapshot['next']>, 'title' | 'at'>;

/** What somebody does next, and in about how many seconds, as of `time`; empty where the plan has nothing. */
export function nextText(next: Next | null | undefined, time: number | null): string {
	if (!next) return '';
	return say().watch.next(next.title, next.at === null || time === null ? null : Math.max(0, Math.round(next.at - time)));
}

export type Progress = NonNullable<WatchSnapshot['progress']>;

/** The same as a watch is told: how far the order in work is, or the operations since the first of them began. */
export function progressIn({ jobs, operations, by_order: byOrder }: Pick<StationView, 'jobs' | 'operations' | 'by_order'>): Progress | null {
	const job = Object.values(jobs).find(({ state }) => state === 'running');
	if (job) {
		const states = Object.values(job.steps).map(({ state }) => state).filter((state) => state !== 'skipped');
		return { done: states.filter((state) => state === 'completed').length, all: states.length };
	}
	const all = Object.values(operations);
	const [first] = all;
	if (byOrder || !first) return null;
	const began = first.active_since ?? first.began ?? 0;
	return { done: all.filter(({ active, ended }) => !active && ended !== null && ended >= began).length, all: all.length };
}

/** The same as a watch is told: what devices do now. What is not heard may do it or not. */
export function doingIn({ plan, abilities, standing, failing }: Pick<StationView, 'plan' | 'abilities' | 'standing' | 'failing'>): { readonly title: string }[] {
	if (standing !== 'working' || failing.length > 0) return [];
	return plan.steps.filter(({ status, ability }) => status === 'running' && !abilities[ability]?.human);
}

/** Whether nothing is made as the station works by order and no order may start. */
export function awaitsOrder({ by_order: byOrder, standing, jobs }: Pick<StationView, 'by_order' | 'standing' | 'jobs'>): boolean {
	return byOrder && whyItStands(standing) === '' && Object.values(jobs).every(({ ended }) => ended !== null);
}
