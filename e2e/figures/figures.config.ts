/** The figures of the pages, measured in Chromium against a real server: `make figures`. Never a timed test of `make test`. */
import { defineConfig } from '@playwright/test';
import tests from '../playwright.config.ts';

export default defineConfig({
	...tests,
	testDir: '.',
	testMatch: '*.figures.ts',
	outputDir: '../artefacts/figures',
	reporter: [['list']],
	timeout: 60 * 60_000,
	workers: 1, // what is measured has the machine for itself
	projects: [{ name: 'figures' }]
});
