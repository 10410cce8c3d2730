/** Pictures of all screens for the documentation: `make pictures`. To be looked at, not compared. */
import { defineConfig } from '@playwright/test';
import tests from '../playwright.config.ts';

export default defineConfig({
	...tests,
	testDir: '.',
	testMatch: '*.pictures.ts',
	outputDir: '../artefacts/pictures',
	reporter: [['list']],
	timeout: 300_000,
	projects: [{ name: 'pictures' }]
});
