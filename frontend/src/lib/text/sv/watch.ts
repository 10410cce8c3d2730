import type { Text } from '../text.svelte.ts';

export const watch: Text['watch'] = {};
