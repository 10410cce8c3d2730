/**
 * The texts in English that are read with the station's pages, beside those of the front: what operators and the frame of
 * all pages say. What the station tells is there too: its sentences it does not bring as text.
 */
import { front } from './en-front.ts';
import { account } from './en/account.ts';
import { alarms } from './en/alarms.ts';
import { figures } from './en/figures.ts';
import { frame } from './en/frame.ts';
import refusals from './en/front.json';
import { history } from './en/history.ts';
import messages from './en/messages.json';
import { mimic } from './en/mimic.ts';
import { operate } from './en/operate.ts';
import { orders } from './en/orders.ts';
import { pages } from './en/pages.ts';
import { restart } from './en/restart.ts';
import { state } from './en/state.ts';
import { trace } from './en/trace.ts';

export const station = { ...front, messages: { ...refusals, ...messages }, account, alarms, figures, frame, history, mimic, operate, orders, pages, restart, state, trace };
