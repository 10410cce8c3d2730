/** The map of the model is the graph of Model now: older links lead on. */
import { redirect } from '@sveltejs/kit';
import { addressOf, lookedAt } from '#lib/station/address.ts';

export function load({ url }: { readonly url: URL }): never {
	redirect(308, addressOf(lookedAt(url.searchParams)));
}
