/** All texts of the pages in Swedish. */
import { account } from './sv/account.ts';
import { alarms } from './sv/alarms.ts';
import { common } from './sv/common.ts';
import { header } from './sv/header.ts';
import { history } from './sv/history.ts';
import { operate } from './sv/operate.ts';
import { pages } from './sv/pages.ts';
import { restart } from './sv/restart.ts';
import { ros } from './sv/ros.ts';
import { state } from './sv/state.ts';
import { watch } from './sv/watch.ts';
import type { Text } from './text.svelte.ts';

export const sv: Text = {
	locale: 'sv-SE',
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
