import type { Text } from '../text.svelte.ts';

export const restart: Text['restart'] = {};
