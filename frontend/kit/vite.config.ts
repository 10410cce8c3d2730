/**
 * How the page is built that shows every part of `lib/ui` in each of its states. Tests look at it; it is no route of the
 * program, whose build (`../vite.config.ts`) knows nothing of this folder.
 */
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

export default defineConfig({
	root: import.meta.dirname,
	publicDir: false,
	plugins: [svelte({ configFile: false })],
	build: { emptyOutDir: true, modulePreload: { polyfill: false }, reportCompressedSize: false }
});
