/** What has to be so before anything can be corrected; the server has the last word. */
import type { StationView } from '#lib/contract.ts';

/** Restart mode has to be entered first. */
export function needsRestart({ mode, production }: Pick<StationView, 'mode' | 'production'>): boolean {
	return mode !== 'restart' && production === 'started';
}
