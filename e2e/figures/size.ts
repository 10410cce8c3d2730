/** What a page brings over the wire. */
import type { Page, Response } from '@playwright/test';
import { gzipSync } from 'node:zlib';

/** Kilobytes (1000 bytes) of the scripts that `page` loads while `visit` lasts, compressed as a server would with gzip. */
export async function scriptsOf(page: Page, visit: () => Promise<unknown>): Promise<number> {
	const found: Response[] = [];
	const heard = (response: Response): void => {
		if (response.request().resourceType() === 'script') found.push(response);
	};
	page.on('response', heard);
	await visit();
	page.off('response', heard);
	const bodies = await Promise.all(found.map((response) => response.body()));
	return bodies.reduce((sum, body) => sum + gzipSync(body, { level: 9 }).length, 0) / 1000;
}
