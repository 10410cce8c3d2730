/** All texts of the pages in English, room by room. Whatever is said there is written here, and in every other language. */
import { front } from './en-front.ts';
import { account } from './en/account.ts';
import { alarms } from './en/alarms.ts';
import { history } from './en/history.ts';
import { model } from './en/model.ts';
import { operate } from './en/operate.ts';
import { restart } from './en/restart.ts';
import { ros } from './en/ros.ts';
import { state } from './en/state.ts';

export const en = { ...front, account, alarms, history, model, operate, restart, ros, state };
