/** Asks for the titles of the model's parts alone, as a watch does. */
import type { Address } from '#lib/contract.ts';
import { request } from '#lib/rest/request.ts';
import { tellTitles } from './titled.svelte.ts';
import type { PartNames } from './titles.ts';

/** Milliseconds after which what was refused is asked for again. */
const AGAIN = 2000;

/** Asks for the titles at `path` until they are told; the result ends that. */
export function askTitles(path: Address): () => void {
	let timer: ReturnType<typeof setTimeout> | undefined;
	let ended = false;
	async function ask(): Promise<void> {
		const answer = await request<PartNames>('GET', path);
		if (ended) return;
		if (answer.ok) tellTitles(answer.value);
		else timer = setTimeout(() => void ask(), AGAIN);
	}
	void ask();
	return () => {
		ended = true;
		clearTimeout(timer);
	};
}
