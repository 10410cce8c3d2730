/** The page of all parts of the kit, as it is built for tests alone. */
import type { BrowserContext } from '@playwright/test';
import { execFile } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { promisify } from 'node:util';

const FRONTEND = join(import.meta.dirname, '../../frontend');
const BUILT = join(import.meta.dirname, '../artefacts/kit');
const ORIGIN = 'http://kit.invalid';
const KINDS: Readonly<Record<string, string>> = { html: 'text/html', js: 'text/javascript', css: 'text/css', woff2: 'font/woff2' };
/** What a station's pages keep to, without the hashes of what SvelteKit writes into them. */
const POLICY = "default-src 'self'; object-src 'none'; base-uri 'self'";

/** Where the page is in a browser that `serveKit` was called for. */
export const KIT = `${ORIGIN}/index.html`;

/** Builds it. */
export async function buildKit(): Promise<void> {
	const vite = join(FRONTEND, 'node_modules/vite/bin/vite.js');
	await promisify(execFile)(process.execPath, [vite, 'build', '--config', 'kit/vite.config.ts', '--outDir', BUILT, '--logLevel', 'error'], {
		cwd: FRONTEND
	});
}

/** Answers what the browser asks of it, from the files. */
export async function serveKit(context: BrowserContext): Promise<void> {
	await context.route(`${ORIGIN}/**`, async (route) => {
		const path = new URL(route.request().url()).pathname;
		const body = await readFile(join(BUILT, path)).catch(() => null);
		if (body === null) return route.fulfill({ status: 404 });
		const contentType = KINDS[path.split('.').at(-1) ?? ''] ?? 'application/octet-stream';
		return route.fulfill({ body, contentType, headers: { 'Content-Security-Policy': POLICY } });
	});
}
