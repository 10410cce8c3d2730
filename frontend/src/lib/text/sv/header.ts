import type { Text } from '../text.svelte.ts';

export const header: Text['header'] = {};
