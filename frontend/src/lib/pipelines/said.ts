/** How what passes an edge is said. */
import type { Json } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { ageText } from '#lib/wording/time.ts';
import type { Seen } from './passing.svelte.ts';
import type { Wire } from './picture.ts';

/** Of more values than this no more are said on a wire, and of longer ones no more signs. */
const MOST_VALUES = 2;
const MOST_SIGNS = 60;

/** A value as it is said: `yes`, `0.25`, `[0.6, -1.2]`, `unknown`. */
export function aloud(value: Json | undefined, { common }: Text): string {
	if (value === null || value === undefined) return common.unknown;
	if (typeof value === 'boolean') return value ? common.yes : common.no;
	if (typeof value === 'number') return String(Math.round(value * 1e4) / 1e4);
	if (typeof value === 'string') return value === '' ? '‘’' : value;
	if (Array.isArray(value)) {
		const items = value.map((each: unknown) => (typeof each === 'number' ? String(Math.round(each * 1e4) / 1e4) : JSON.stringify(each)));
		return `[${items.join(', ')}]`;
	}
	return JSON.stringify(value);
}

const cut = (text: string): string => (text.length > MOST_SIGNS ? `${text.slice(0, MOST_SIGNS)}…` : text);

/** Those that were made: to make one takes longer than all else on a wire, and each says its rate twice a second. */
const formats = new Map<string, Intl.NumberFormat>();

function formatFor(locale: string, digits: number): Intl.NumberFormat {
	const key = `${locale} ${digits}`;
	const made = formats.get(key) ?? new Intl.NumberFormat(locale, { maximumFractionDigits: digits });
	formats.set(key, made);
	return made;
}

/** Records a second: `10/s`. */
export function rateText(rate: number | null, { locale, pipelines }: Text): string {
	return rate === null ? '' : pipelines.rate(formatFor(locale, rate < 10 ? 1 : 0).format(rate));
}

/** The lines on a wire: how often, how old, and the values that are `news` there. */
export function saidOf(
	{ field, fields }: Pick<Wire, 'field' | 'fields'>,
	record: Readonly<Record<string, Json>> | null,
	news: readonly string[],
	seen: Seen | null,
	isRun: boolean,
	texts: Text
): string[] {
	const { pipelines, common } = texts;
	const values = news.slice(0, MOST_VALUES).flatMap((name) => {
		if (record === null || !(name in record)) return [];
		return [cut(field === null ? `${name} = ${aloud(record[name], texts)}` : aloud(record[name], texts))];
	});
	const often = seen && field === null ? rateText(seen.rate, texts) : '';
	const age = seen?.isOld && seen.age !== null ? common.time.ago(ageText(seen.age * 1000)) : '';
	const count = Object.keys(fields).length;
	const what = values.length > 0 || field !== null ? values : [record === null && isRun ? pipelines.nothingPassed : count === 0 ? '' : pipelines.fields(count)];
	return [[often, age].filter(Boolean).join(' · '), ...what].filter(Boolean);
}
