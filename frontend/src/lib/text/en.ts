/** All texts of the pages in English, room by room. Whatever is said there is written here, and in every other language. */
import { station as ofStation } from './en-station.ts';
import { ability } from './en/ability.ts';
import { backups } from './en/backups.ts';
import { begin } from './en/begin.ts';
import { check } from './en/check.ts';
import { examples } from './en/examples.ts';
import { review } from './en/review.ts';
import { model } from './en/model.ts';
import { picture } from './en/picture.ts';
import { pipelines } from './en/pipelines.ts';
import { ros } from './en/ros.ts';
import { sequence } from './en/sequence.ts';
import { station } from './en/station.ts';
import { storage } from './en/storage.ts';
import { tryOut } from './en/try-out.ts';
import { webhooks } from './en/webhooks.ts';
import { whatIf } from './en/what-if.ts';

export const en = { ...ofStation, ability, backups, begin, check, examples, model, picture, pipelines, ros, review, sequence, station, storage, tryOut, webhooks, whatIf };
