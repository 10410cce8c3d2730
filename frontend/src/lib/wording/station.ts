/** How the state of execution is said, in the language of the page. */
import type { StationView } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** What happens next, and what does not. */
export function modeMeaning({ mode, production }: Pick<StationView, 'mode' | 'production'>): string {
	const { meaning, nothingSent } = say().frame;
	if (production === 'started') return meaning[mode];
	return mode === 'automatic' ? nothingSent : `${meaning[mode]} ${nothingSent}`;
}

/** Milliseconds the planner took: `0.4 ms`, `12 ms`, `1.2 s`. */
export function plannerTime(milliseconds: number): string {
	const { ms, s } = say().common.time;
	if (milliseconds < 10) return ms(Number(milliseconds.toFixed(1)));
	if (milliseconds < 1000) return ms(Math.round(milliseconds));
	return s((milliseconds / 1000).toFixed(1));
}
