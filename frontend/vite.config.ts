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
import manifest from './package.json' with { type: 'json' };

/** Where `npm run dev` finds a running station. */
const server = process.env['STATION_SERVER'] ?? 'http://127.0.0.1:8000';

export default defineConfig({
	plugins: [
		sveltekit({
			// The server sends what is compressed here to whoever takes it.
			adapter: adapter({ fallback: '404.html', precompress: true }),
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
				rolldownOptions: {
					output: {
						// What pages share comes in few files: each one more takes longer to ask for than to bring. What all of it
						// stands on is apart, or it would be merged with what stands on it, and files import one another in a circle.
						codeSplitting: {
							groups: [
								{ name: 'svelte', test: /node_modules\/svelte\//, priority: 1, entriesAware: true },
								// The watch tells no messages of a station, and would have these with what it shares with other pages.
								{
									name: 'messages',
									test: /lib\/(text\/message|plan\/next-step|wording\/breakable|alarm\/(priority|alarm-mark))/,
									priority: 1,
									entriesAware: true
								},
								// The watch reads the stream, asks the server who is there, and knows where it is framed, as other pages do, and would
								// have what these read with it.
								{ name: 'stream', test: /lib\/(stream\/|account\/asking|wall\/framed)/, priority: 1, entriesAware: true },
								// So is what the names of variables stand on, which all but the watch's pages read.
								{ name: 'names', test: /lib\/wording\/(names|values)/, priority: 1, entriesAware: true },
								{ name: 'shared', minShareCount: 2, entriesAware: true, entriesAwareMergeThreshold: 1_000 }
							]
						},
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
	test: { include: ['src/**/*.test.ts'], setupFiles: ['src/lib/testing/texts.ts'], isolate: false, testTimeout: 60_000 }
});
