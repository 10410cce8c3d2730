import type { Text } from '../text.svelte.ts';

export const account: Text['account'] = {};
