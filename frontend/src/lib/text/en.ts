/** All texts of the pages in English, room by room. Whatever is said there is written here, and in every other language. */
import { account } from './en/account.ts';
import { alarms } from './en/alarms.ts';
import { common } from './en/common.ts';
import { header } from './en/header.ts';
import { history } from './en/history.ts';
import { operate } from './en/operate.ts';
import { pages } from './en/pages.ts';
import { restart } from './en/restart.ts';
import { ros } from './en/ros.ts';
import { state } from './en/state.ts';
import { watch } from './en/watch.ts';

export const en = {
	/** For numbers and dates. */
	locale: 'en-GB',
	account,
	alarms,
	common,
	header,
	history,
	operate,
	pages,
	restart,
	ros,
	state,
	watch
};
