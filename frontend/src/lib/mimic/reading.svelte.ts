import type { Mimic } from '#lib/contract.ts';
import { Reading } from '#lib/rest/reading.svelte.ts';
import { useStation } from '#lib/stream/station.svelte.ts';
import { language } from '#lib/text/text.svelte.ts';
import { calledIn, type Called } from './called.ts';

/** Milliseconds after which a picture that was refused is asked for again. */
const AGAIN = 2000;

/** The picture of the station. With another model it is another; while the station is being prepared it has none. */
export function readPicture(): Reading<Mimic> {
	const station = useStation();
	const reading = new Reading<Mimic>('/api/v1/mimic');
	const model = $derived(`${station.view?.station.name} ${station.view?.deployment?.revision ?? ''}`);
	const known = $derived(station.view !== null && station.view.standing !== 'preparing');
	$effect(() => {
		void model;
		if (!known) return;
		void reading.again();
		const timer = setInterval(() => reading.refusal && void reading.again(), AGAIN);
		return () => clearInterval(timer);
	});
	return reading;
}

/** How resources are drawn and called in the picture of the station, as long as that is read. */
export function readCalled(): { readonly value: ReadonlyMap<string, Called> } {
	const station = useStation();
	const picture = readPicture();
	const value = $derived(calledIn(picture.value, station.view, language()));
	return {
		get value() {
			return value;
		}
	};
}
