import type { Text } from '../text.svelte.ts';

export const operate: Text['operate'] = {};
