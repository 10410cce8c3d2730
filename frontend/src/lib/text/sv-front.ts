/**
 * The texts in Swedish that are read with every page: what the watch and the pages before the sign-in say, and
 * nothing of the station's own pages.
 */
import { common } from './sv/common.ts';
import { door } from './sv/door.ts';
import { watch } from './sv/watch.ts';
import type { Front } from './text.svelte.ts';

export const front: Front = { locale: 'sv-SE', common, door, messages: {}, watch };
