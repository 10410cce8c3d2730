/** All texts of the pages in Swedish. */
import { front } from './sv-front.ts';
import { ability } from './sv/ability.ts';
import { account } from './sv/account.ts';
import refusals from './sv/front.json';
import messages from './sv/messages.json';
import { alarms } from './sv/alarms.ts';
import { backups } from './sv/backups.ts';
import { check } from './sv/check.ts';
import { deploy } from './sv/deploy.ts';
import { frame } from './sv/frame.ts';
import { history } from './sv/history.ts';
import { mimic } from './sv/mimic.ts';
import { model } from './sv/model.ts';
import { operate } from './sv/operate.ts';
import { orders } from './sv/orders.ts';
import { pipelines } from './sv/pipelines.ts';
import { restart } from './sv/restart.ts';
import { ros } from './sv/ros.ts';
import { state } from './sv/state.ts';
import { station } from './sv/station.ts';
import { storage } from './sv/storage.ts';
import { webhooks } from './sv/webhooks.ts';
import { whatIf } from './sv/what-if.ts';
import type { Text } from './text.svelte.ts';

export const sv: Text = { ...front, ability, account, alarms, messages: { ...refusals, ...messages }, backups, check, deploy, frame, history, mimic, model, operate, orders, pipelines, restart, ros, state, station, storage, webhooks, whatIf };
