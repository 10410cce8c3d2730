/** Where the focus goes when parts come and go. */
import { tick } from 'svelte';
import { keyOf } from './places.ts';

/** To a field of a part that was just added; what stands in it is taken the place of by what is typed. */
export async function attendTo(id: number | null, field = 'title'): Promise<void> {
	await tick();
	const found = document.querySelector<HTMLElement>(`[data-at="${keyOf(id, field)}"]`);
	found?.focus();
	if (found instanceof HTMLInputElement) found.select();
}

/** After `change` takes a row away: to the one that stands there then, or to what is beside the list. */
export async function attendBeside(button: HTMLElement, change: () => void): Promise<void> {
	const row = button.closest('[data-row]');
	const list = row?.parentElement;
	const beside = [row?.nextElementSibling, row?.previousElementSibling].find((each) => each?.matches('[data-row]'));
	change();
	await tick();
	const within = 'input, select, button';
	const found = beside?.isConnected ? beside.querySelector<HTMLElement>(within) : null;
	(found ?? list?.parentElement?.querySelector<HTMLElement>('button'))?.focus();
}
