import type { Text } from '../text.svelte.ts';

export const alarms: Text['alarms'] = {};
