import type { Text } from '../text.svelte.ts';

export const history: Text['history'] = {};
