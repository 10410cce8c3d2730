/** All rooms of the catalogue, in English, for tests: they run outside the pages that furnish them. */
import { vi } from 'vitest';
import { en } from '#lib/text/en.ts';
import { furnish } from '#lib/text/text.svelte.ts';
import { sv } from '#lib/text/sv.ts';

vi.stubGlobal('document', { documentElement: {} });
vi.stubGlobal('navigator', { languages: ['en'] });
await furnish({ en: () => en, sv: () => sv });
vi.unstubAllGlobals();
