/**
 * Rows of two texts each: how mappings and tables of stages are written in a form, and read from it.
 *
 * A text that would be read as a number, a truth value or several is written between single quotes.
 */
import { isList, isMapping, type Json } from './content.ts';
import type { FieldKind } from './shape.ts';

export type Pair = readonly [string, string];
type PairKind = 'named' | 'numbers' | 'words' | 'bounds' | 'rows' | 'couples';

const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/;
const KINDS: ReadonlySet<FieldKind> = new Set<PairKind>(['named', 'numbers', 'words', 'bounds', 'rows', 'couples']);

/** Whether it is written as rows of two texts each. */
export function isPairs(kind: FieldKind): kind is PairKind {
	return KINDS.has(kind);
}

const isScalar = (value: Json | undefined): boolean => ['string', 'number', 'boolean'].includes(typeof value);

/** The scalar that is written. */
export function scalarRead(written: string): Json {
	const bare = written.trim();
	if (bare === 'true' || bare === 'false') return bare === 'true';
	if (NUMBER.test(bare)) return Number(bare);
	return /^'([^']*)'$/.exec(bare)?.[1] ?? bare;
}

/** How a scalar is written. */
export function scalarShown(value: Json | undefined): string {
	return typeof value === 'string' && scalarRead(value) !== value ? `'${value}'` : String(value ?? '');
}

/** The scalars that are written with commas between. */
export function listRead(written: string): Json[] {
	return (written.match(/(?:'[^']*'|[^,'])+/g) ?? []).map((each) => each.trim()).filter(Boolean).map(scalarRead);
}

/** How a list of scalars is written; null is no bound. */
export function listShown(values: readonly Json[]): string {
	return values
		.map((value) => {
			if (value === null) return 'null';
			return typeof value === 'string' && value.includes(',') ? `'${value}'` : scalarShown(value);
		})
		.join(', ');
}

const numbersRead = (written: string): Json[] =>
	written
		.split(',')
		.map((each) => each.trim())
		.filter(Boolean)
		.map((each) => (each === 'null' ? null : NUMBER.test(each) ? Number(each) : NaN));

const INTERVAL = /^\s*(\S+?)\s*\.\.\s*(\S+)\s*$/;

function boundsShown(value: Json | undefined): string {
	if (!isMapping(value)) return '';
	if (isList(value['between'])) return value['between'].map(String).join('..');
	return isList(value['in']) ? listShown(value['in']) : '';
}

function boundsRead(written: string): Json {
	const [, least = '', most = ''] = INTERVAL.exec(written) ?? [];
	return NUMBER.test(least) && NUMBER.test(most) ? { between: [Number(least), Number(most)] } : { in: listRead(written) };
}

/** A name, or several with commas between. */
const memberShown = (value: Json | undefined): string => listShown(isList(value) ? value : [value ?? '']);

function memberRead(written: string): Json {
	const found = listRead(written).map(String);
	return found.length === 1 ? (found[0] ?? '') : found;
}

/** What can be written so that nothing of it is lost. */
export function pairsFit(kind: PairKind, value: Json): boolean {
	const scalars = (list: Json | undefined): boolean =>
		isList(list) && list.every((each) => isScalar(each) && !(typeof each === 'string' && each.includes("'")));
	if (kind === 'rows')
		return isList(value) && value.every((row) => isMapping(row) && scalars(row['when']) && scalars(row['gives']));
	if (kind === 'couples') {
		const isMember = (side: Json | undefined): boolean => (isList(side) ? scalars(side) : scalars([side ?? null]));
		return isList(value) && value.every((pair) => isList(pair) && pair.length === 2 && pair.every(isMember));
	}
	if (!isMapping(value)) return false;
	return Object.values(value).every((each) => {
		switch (kind) {
			case 'named':
				return isScalar(each);
			case 'numbers':
				return isList(each) && each.every((item) => item === null || typeof item === 'number');
			case 'words':
				return scalars(each);
			case 'bounds':
				return isMapping(each) && (isList(each['between']) || scalars(each['in']));
		}
	});
}

export function pairsShown(kind: PairKind, value: Json | undefined): Pair[] {
	if (kind === 'rows')
		return (isList(value) ? value : []).map((row) => {
			const { when, gives } = isMapping(row) ? row : { when: [], gives: [] };
			return [listShown(isList(when) ? when : []), listShown(isList(gives) ? gives : [])];
		});
	if (kind === 'couples')
		return (isList(value) ? value : []).map((pair) =>
			isList(pair) ? [memberShown(pair[0]), memberShown(pair[1])] : ['', '']
		);
	return Object.entries(isMapping(value) ? value : {}).map(([name, each]): Pair => {
		if (kind === 'named') return [name, scalarShown(each)];
		return [name, kind === 'bounds' ? boundsShown(each) : listShown(isList(each) ? each : [])];
	});
}

export function pairsRead(kind: PairKind, pairs: readonly Pair[]): Json {
	if (kind === 'rows') return pairs.map(([when, gives]) => ({ when: listRead(when), gives: listRead(gives) }));
	if (kind === 'couples') return pairs.map(([one, other]) => [memberRead(one), memberRead(other)]);
	return Object.fromEntries(
		pairs.map(([name, each]): [string, Json] => {
			switch (kind) {
				case 'named':
					return [name.trim(), scalarRead(each)];
				case 'numbers':
					return [name.trim(), numbersRead(each)];
				case 'words':
					return [name.trim(), listRead(each).map(String)];
				case 'bounds':
					return [name.trim(), boundsRead(each)];
			}
		})
	);
}

/** What is wrong with what is written; null where it can be read. */
export function pairsBad(kind: PairKind, pairs: readonly Pair[]): 'pair' | 'number' | 'twice' | null {
	if (pairs.some(([name, each]) => !name.trim() || !each.trim())) return 'pair';
	if (kind === 'numbers' && pairs.some(([, each]) => numbersRead(each).some((item) => Number.isNaN(item)))) return 'number';
	if (kind === 'rows' || kind === 'couples') return null;
	return new Set(pairs.map(([name]) => name.trim())).size < pairs.length ? 'twice' : null;
}
