/**
 * End-to-end tests: a real Chromium, the real server, and emulated devices that speak real DDS.
 *
 * Each station has a free port and a DDS domain of its own (`station/station.ts`); tests that do not disturb one another
 * share one (`station/bench.ts`), and lie in one folder, so that they come one after the other. What a theme can change
 * is tagged `@theme` and runs in both in campaigns, where `@long` runs too.
 */
import { defineConfig } from '@playwright/test';
import { chromium } from './station/chromium.ts';

/** Chromium keeps to this machine: it looks nothing up and reports nothing. */
const FLAGS = [
	'--no-sandbox',
	'--disable-background-networking',
	'--disable-component-update',
	'--disable-sync',
	'--no-first-run',
	'--disable-default-apps',
	'--disable-domain-reliability',
	'--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1 , EXCLUDE localhost'
];

export default defineConfig({
	testDir: 'specs',
	outputDir: 'artefacts/results',
	reporter: [['list'], ['html', { outputFolder: 'artefacts/report', open: 'never' }]],
	// Two cores: the machines that run this have no more, and each station is several processes.
	workers: 2,
	// What takes long is for the campaigns: `LONG=yes`.
	...(process.env['LONG'] ? {} : { grepInvert: /@long/ }),
	forbidOnly: Boolean(process.env['CI']),
	timeout: 120_000,
	expect: { timeout: 15_000 },
	use: {
		viewport: { width: 1440, height: 900 },
		launchOptions: { executablePath: chromium(), args: FLAGS },
		screenshot: 'only-on-failure',
		trace: process.env['TRACE'] ? 'retain-on-failure' : 'off' // it makes every step slower
	},
	projects: [
		{ name: 'light', use: { colorScheme: 'light' } },
		// What a test examines it examines in both themes; all else in the dark is for campaigns.
		...(process.env['LONG'] ? [{ name: 'dark', use: { colorScheme: 'dark' as const }, grep: /@theme/ }] : [])
	]
});
