/** Where a page is looked at, as its address says. */
import { goto } from '$app/navigation';
import { page } from '$app/state';

/**
 * The address of the page. One that is on its way counts as there already: what is asked for next, by a quick click or
 * key, goes on from it and not from what was left.
 */
class Address {
	#coming = $state.raw<URL | null>(null);

	get query(): typeof page.url.searchParams {
		return (this.#coming ?? page.url).searchParams;
	}

	/** Goes to another part of the page; resolves when it is there, or when somebody went elsewhere meanwhile. */
	async go(to: string, { replace = false }: { readonly replace?: boolean } = {}): Promise<void> {
		const coming = new URL(to, page.url.href);
		this.#coming = coming;
		try {
			await goto(to, { reset: false, replace });
		} finally {
			if (this.#coming === coming) this.#coming = null;
		}
	}
}

export const address = new Address();
