/** The mark of each mode: a shape of its own, so that it is told from afar. */
import OctagonPause from '@lucide/svelte/icons/octagon-pause';
import Pause from '@lucide/svelte/icons/pause';
import Play from '@lucide/svelte/icons/play';
import RotateCcw from '@lucide/svelte/icons/rotate-ccw';
import type { StationView } from '#lib/contract.ts';

export const MODE_MARKS = { automatic: Play, paused: Pause, hold: OctagonPause, restart: RotateCcw };

/** Whether the mode looks like well-being: the station works by itself, hears all its devices, and is not outside its safe states. */
export function isWell(view: StationView): boolean {
	return view.standing === 'working' && view.way_back === null;
}
