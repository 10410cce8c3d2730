import type { Text } from '../text.svelte.ts';

export const state: Text['state'] = {};
