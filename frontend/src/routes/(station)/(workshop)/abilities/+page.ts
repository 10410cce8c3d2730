/** An ability is a part of Model now: older links lead on. */
import { redirect } from '@sveltejs/kit';
import { addressOf } from '#lib/ability/address.ts';

export function load({ url }: { readonly url: URL }): never {
	const name = url.searchParams.get('name');
	redirect(308, name ? addressOf(name) : '/model');
}
