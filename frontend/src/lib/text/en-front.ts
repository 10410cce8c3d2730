/**
 * The texts in English that are read with every page: what the watch and the pages before the sign-in say, and
 * nothing of the station's own pages.
 */
import { common } from './en/common.ts';
import { door } from './en/door.ts';
import { watch } from './en/watch.ts';

/** A refusal says itself in English what it says: its texts need not be brought along for that. */
const messages: Readonly<Record<string, string>> = {};

export const front = {
	/** For numbers and dates. */
	locale: 'en-GB',
	common,
	door,
	messages,
	watch
};
