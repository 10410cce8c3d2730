/** The kinds of stages, as they are looked for: in groups, each with its mark. */
import type { Component } from 'svelte';
import Rename from '@lucide/svelte/icons/arrow-left-right';
import Match from '@lucide/svelte/icons/regex';
import OneOf from '@lucide/svelte/icons/circle-dot';
import Member from '@lucide/svelte/icons/list-checks';
import MapIcon from '@lucide/svelte/icons/map';
import Table from '@lucide/svelte/icons/table-2';
import Expression from '@lucide/svelte/icons/square-function';
import Constant from '@lucide/svelte/icons/equal';
import Discretise from '@lucide/svelte/icons/ruler';
import Undiscretise from '@lucide/svelte/icons/spline';
import Override from '@lucide/svelte/icons/sliders-horizontal';
import Python from '@lucide/svelte/icons/file-code';
import Remember from '@lucide/svelte/icons/history';
import Fold from '@lucide/svelte/icons/layers';
import Debounce from '@lucide/svelte/icons/hourglass';
import Filter from '@lucide/svelte/icons/funnel';
import Limit from '@lucide/svelte/icons/gauge';
import Tick from '@lucide/svelte/icons/timer';
import Timeout from '@lucide/svelte/icons/alarm-clock-off';
import { helpIn } from '#lib/model/field-help.svelte.ts';
import { PARTS } from '#lib/model/documents.ts';
import type { Text } from '#lib/text/text.svelte.ts';

const GROUPS = {
	names: { rename: Rename, map: MapIcon, table: Table, one_of: OneOf, match: Match, member: Member },
	values: { expression: Expression, constant: Constant, discretise: Discretise, undiscretise: Undiscretise, override: Override, python: Python },
	time: { remember: Remember, fold: Fold, debounce: Debounce, filter: Filter, limit: Limit, tick: Tick, timeout: Timeout }
} as const;

export type StageGroup = keyof typeof GROUPS | 'other';
export type Icon = Component<{ size?: string; strokeWidth?: number; 'aria-hidden'?: boolean }>;

const ICONS: Readonly<Record<string, Icon>> = Object.assign({}, ...Object.values(GROUPS));

export const iconOf = (kind: string): Icon => ICONS[kind] ?? Python;

/** What a kind is called by people; its name in files where that is not known. */
export const kindTitle = (kind: string, { pipelines: { kindTitles } }: Pick<Text, 'pipelines'>): string => (isTitled(kind, kindTitles) ? kindTitles[kind] : kind);

const isTitled = <Titles extends object>(kind: string, titles: Titles): kind is keyof Titles & string => Object.hasOwn(titles, kind);

/** What a kind does, in a sentence. */
export const helpOf = (kind: string): string => helpIn(PARTS['stage']?.fields[kind]?.help ?? '');

/** The kinds that the documents know, by group; those of none are the last. */
export function kindsByGroup(): [StageGroup, readonly string[]][] {
	const known = Object.keys(PARTS['stage']?.fields ?? {});
	const groups = Object.entries(GROUPS).map(([group, kinds]): [StageGroup, string[]] => [group as StageGroup, Object.keys(kinds).filter((kind) => known.includes(kind))]);
	const others = known.filter((kind) => !(kind in ICONS));
	return others.length > 0 ? [...groups, ['other', others]] : groups;
}
