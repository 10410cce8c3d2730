/** All texts of the pages in English, room by room. Whatever is said there is written here, and in every other language. */
import { front } from './en-front.ts';
import { ability } from './en/ability.ts';
import { account } from './en/account.ts';
import refusals from './en/front.json';
import messages from './en/messages.json';
import { alarms } from './en/alarms.ts';
import { backups } from './en/backups.ts';
import { check } from './en/check.ts';
import { deploy } from './en/deploy.ts';
import { frame } from './en/frame.ts';
import { history } from './en/history.ts';
import { mimic } from './en/mimic.ts';
import { model } from './en/model.ts';
import { operate } from './en/operate.ts';
import { orders } from './en/orders.ts';
import { pipelines } from './en/pipelines.ts';
import { restart } from './en/restart.ts';
import { ros } from './en/ros.ts';
import { state } from './en/state.ts';
import { station } from './en/station.ts';
import { storage } from './en/storage.ts';
import { webhooks } from './en/webhooks.ts';
import { whatIf } from './en/what-if.ts';

export const en = { ...front, ability, account, alarms, messages: { ...refusals, ...messages }, backups, check, deploy, frame, history, mimic, model, operate, orders, pipelines, restart, ros, state, station, storage, webhooks, whatIf };
