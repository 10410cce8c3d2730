/** How long abilities took in the station's past, for those who may read its history. */
import type { TimeLine } from '#lib/contract.ts';
import { runsOf } from '#lib/history/lanes.ts';
import { request } from '#lib/rest/request.ts';

/** Seconds that are looked back on, the longest first: a busy station has too much to tell of a long time. */
const SPANS = [14_400, 1800, 300];
const PATIENCE = 15_000; // milliseconds

export class Durations {
	#runs = $state.raw<ReadonlyMap<string, readonly number[]>>(new Map());

	/** Seconds that each run of an ability took; none where none is known. */
	of(ability: string): readonly number[] {
		return this.#runs.get(ability) ?? [];
	}

	/** Looks back from `now` (seconds since the epoch). */
	async read(now: number): Promise<void> {
		for (const span of SPANS) {
			const window = { from: now - span, to: now };
			const query = new URLSearchParams({ since: String(window.from), until: String(window.to) });
			const answer = await request<TimeLine>('GET', `/api/v1/history/line?${query}`, { patience: PATIENCE });
			if (!answer.ok) return;
			if (!answer.value.whole) continue;
			this.#runs = durationsOf(answer.value, window);
			return;
		}
	}
}

/** How long runs took that began and ended in the window by themselves. */
export function durationsOf(line: TimeLine, window: { readonly from: number; readonly to: number }): Map<string, number[]> {
	const found = new Map<string, number[]>();
	for (const [ability, bars] of runsOf(line, window, window.to)) {
		const whole = bars.filter(({ open, failed, number }) => !open && failed !== true && number !== null);
		if (whole.length > 0) found.set(ability, whole.map(({ from, to }) => to - from));
	}
	return found;
}

/** How long runs of an ability usually took: of many the quickest and the slowest tenth are left out. */
export interface Usual {
	readonly least: number;
	readonly most: number;
	readonly runs: number;
	readonly median: number;
}

/** Of fewer runs than these all count. */
const MANY = 10;
/** Fewer runs than these say little. */
const FEW = 3;
/** A median that is this much beside what is written fits it. */
const BESIDE = 0.1;

/** What is usual of these runs, in seconds; null where there were none. */
export function usualOf(runs: readonly number[]): Usual | null {
	const sorted = runs.toSorted((one, other) => one - other);
	const left = sorted.length < MANY ? 0 : Math.floor(sorted.length / 10);
	const [least, most] = [sorted[left], sorted.at(-1 - left)];
	const median = sorted[Math.floor(sorted.length / 2)];
	if (least === undefined || most === undefined || median === undefined) return null;
	return { least: tenths(least), most: tenths(most), runs: sorted.length, median };
}

const tenths = (seconds: number): number => Math.round(seconds * 10) / 10;

/** Whether what is written of how long an ability takes is about so. */
export function fitsUsual([least, most]: readonly [number, number], { median, runs }: Usual): boolean {
	return runs < FEW || (median >= least * (1 - BESIDE) && median <= most * (1 + BESIDE));
}
