/** All texts of the pages in Swedish. */
import { station as ofStation } from './sv-station.ts';
import { ability } from './sv/ability.ts';
import { backups } from './sv/backups.ts';
import { begin } from './sv/begin.ts';
import { check } from './sv/check.ts';
import { examples } from './sv/examples.ts';
import { review } from './sv/review.ts';
import { model } from './sv/model.ts';
import { picture } from './sv/picture.ts';
import { pipelines } from './sv/pipelines.ts';
import { ros } from './sv/ros.ts';
import { sequence } from './sv/sequence.ts';
import { station } from './sv/station.ts';
import { storage } from './sv/storage.ts';
import { tryOut } from './sv/try-out.ts';
import { webhooks } from './sv/webhooks.ts';
import { whatIf } from './sv/what-if.ts';
import type { Text } from './text.svelte.ts';

export const sv: Text = { ...ofStation, ability, backups, begin, check, examples, model, picture, pipelines, ros, review, sequence, station, storage, tryOut, webhooks, whatIf };
