/** The texts in Swedish that are read with the station's pages, and what the station tells. */
import { front } from './sv-front.ts';
import { account } from './sv/account.ts';
import { alarms } from './sv/alarms.ts';
import { figures } from './sv/figures.ts';
import findings from './sv/findings.json';
import { frame } from './sv/frame.ts';
import refusals from './sv/front.json';
import { history } from './sv/history.ts';
import { mimic } from './sv/mimic.ts';
import messages from './sv/messages.json';
import { operate } from './sv/operate.ts';
import { orders } from './sv/orders.ts';
import { pages } from './sv/pages.ts';
import { restart } from './sv/restart.ts';
import { state } from './sv/state.ts';
import { trace } from './sv/trace.ts';
import type { OfStation } from './text.svelte.ts';

export const station: OfStation = { ...front, account, alarms, figures, frame, history, mimic, operate, orders, pages, restart, state, trace, messages: { ...refusals, ...messages, ...findings } };
