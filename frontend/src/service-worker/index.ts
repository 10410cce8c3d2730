/** What the browser runs for the watch beside its page: it answers with the kept shell where the server does not. */
import { PAGE, Shell } from '#lib/shell/shell.ts';

const worker = self as unknown as ServiceWorkerGlobalScope;
/** Files of the build that a page may ask for; all else, what the server tells above all, goes past this worker. */
const FILES = /^\/(?:_app\/immutable\/.+|[\w-]+\.(?:js|svg|png|webmanifest))$/;
const shell = caches.open('watch').then((kept) => new Shell(kept, (address, init) => fetch(address, init)));

worker.addEventListener('install', (event) => {
	event.waitUntil(
		shell.then(async (each) => {
			await each.install();
			await worker.skipWaiting();
		})
	);
});

worker.addEventListener('activate', (event) => event.waitUntil(worker.clients.claim()));

worker.addEventListener('fetch', (event) => {
	const { request } = event;
	const url = new URL(request.url);
	if (request.method !== 'GET' || url.origin !== worker.location.origin) return;
	if (request.mode === 'navigate') {
		if (url.pathname === PAGE)
			event.respondWith(shell.then((each) => each.page((work) => event.waitUntil(work))));
		return;
	}
	if (FILES.test(url.pathname)) event.respondWith(shell.then((each) => each.file(url.pathname)));
});
