/** What a page brings over the wire. */
import type { Page, Request } from '@playwright/test';

/** Kilobytes (1000 bytes) of the scripts that `page` loads while `visit` lasts, as the server sends them: compressed. */
export async function scriptsOf(page: Page, visit: () => Promise<unknown>): Promise<number> {
	const found: Request[] = [];
	const heard = (request: Request): void => {
		if (request.resourceType() === 'script') found.push(request);
	};
	page.on('requestfinished', heard);
	await visit();
	page.off('requestfinished', heard);
	const sizes = await Promise.all(found.map((request) => request.sizes()));
	return sizes.reduce((sum, { responseBodySize }) => sum + responseBodySize, 0) / 1000;
}
