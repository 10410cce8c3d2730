/**
 * How the pages are built: one prerendered document for each and their scripts, served as plain files.
 *
 * Nothing comes from another host and no script is written into the page unhashed, so the Content-Security-Policy
 * that SvelteKit puts into each document allows only what was built here.
 */
import adapter from '@sveltejs/adapter-static';
import { sveltekit } from '@sveltejs/kit/vite';
import { defineConfig } from 'vitest/config';
import { noCycles } from './scripts/no-cycles.ts';
import { shares } from './scripts/shares.ts';
import manifest from './package.json' with { type: 'json' };

/** Where `npm run dev` finds a running station. */
const server = process.env['STATION_SERVER'] ?? 'http://127.0.0.1:8000';

export default defineConfig({
	plugins: [
		sveltekit({
			// The server sends what is compressed here to whoever takes it.
			adapter: adapter({ fallback: '404.html', precompress: true }),
			inlineStyleThreshold: 40_000,
			// The watch alone has a worker, and registers it.
			serviceWorker: { register: false },
			csp: {
				mode: 'hash',
				directives: {
					'default-src': ['self'],
					// SvelteKit hides what it says to screen readers with one `style` attribute; this is its hash.
					'style-src-attr': ['unsafe-hashes', 'sha256-S8qMpvofolR8Mpjy4kQvEm7m1q8clzU4dfDH0AmvZjo='],
					'base-uri': ['self'],
					'object-src': ['none'],
					// Which frames there may be the server says in a header; browsers keep to both.
					'frame-src': ['http:', 'https:'],
					'form-action': ['self']
				}
			},
			// The version is only compared for equality; a clock here would make every build differ.
			version: { name: manifest.version, pollInterval: 0 }
		}),
		noCycles()
	],
	environments: {
		client: {
			build: {
				modulePreload: {
					// What all pages begin with would name the scripts of each, which is more than the rest of it: a page that is opened
					// by its address links to its own, and one that is gone to asks for them as it reads them.
					resolveDependencies: (_, scripts, { hostId }) => (hostId.includes('/entry/') ? [] : scripts)
				},
				rolldownOptions: {
					output: {
						codeSplitting: { groups: shares() },
						// Those are called after all pages that share them, which are no folders.
						sanitizeFileName: (name) => name.replace(/^shared~.*/, 'shared').replace(/[^\w./-]/g, '_')
					}
				}
			}
		}
	},
	server: { proxy: { '/api': { target: server, ws: true, changeOrigin: true } } },
	// What is tested keeps nothing to itself, so one process does for all files: that takes a fraction of the time. Laws are
	// tried with many examples, which takes some seconds where others have the processors.
	test: { include: ['src/**/*.test.ts'], setupFiles: ['src/lib/testing/texts.ts', 'src/lib/testing/laws.ts'], isolate: false, testTimeout: 60_000 }
});
