/** The figures of the day as the server reckons them, read again whenever something may have changed them. */
import type { Figures } from '#lib/contract.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';
import { useStation } from '#lib/stream/station.svelte.ts';
import { standstillOf } from './standstill.ts';

/** Milliseconds between two looks. */
const EVERY = 10_000;
/** Milliseconds after a change by which the server has read of it in the journal. */
const SOON = 2500;

/** The figures, for the component that is being made. */
export function readFigures(): Reading<Figures> {
	const station = useStation();
	const reading = new Reading<Figures>('/api/v1/figures');
	/** What is in work, and how often something was done: the stream tells that at once. */
	const work = $derived.by(() => {
		const jobs = Object.entries(station.view?.jobs ?? {}).map(([id, job]) => `${id} ${job.state}`);
		const done = Object.values(station.view?.operations ?? {}).reduce((sum, { completed }) => sum + completed, 0);
		return [...jobs, done, station.view?.by_order, standstillOf(station.view, station.time)].join();
	});
	const live = $derived(station.live);

	$effect(() => {
		void work;
		if (!live) return;
		const end = reading.every(EVERY);
		const soon = setTimeout(() => void reading.again(), SOON);
		return () => {
			end();
			clearTimeout(soon);
		};
	});
	return reading;
}
