import type { Text } from '../text.svelte.ts';

export const ros: Text['ros'] = {};
