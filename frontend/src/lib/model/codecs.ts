/** How the value of a field is written in a form, and read from it. */
import { isList, isMapping, type Json } from './content.ts';
import { isPairs, pairsBad, pairsFit, pairsRead, pairsShown, scalarRead, scalarShown, type Pair } from './pairs.ts';
import { areParameters } from './parameters.ts';
import type { FieldKind, FieldShape } from './shape.ts';

/** A value as it is written in a form: a text, two, many, names with what is behind them, or a tick. */
export type Written = string | boolean | readonly string[] | readonly (readonly [string, string])[];

/** Why what is written is no value, in the catalogue. */
export type BadValue = 'number' | 'whole' | 'least' | 'most' | 'required' | 'order' | 'pair' | 'twice' | 'name';

const isScalar = (value: Json | undefined): value is string | number | boolean =>
	['string', 'number', 'boolean'].includes(typeof value);
const text = (value: Json | undefined): string => (isScalar(value) ? String(value) : '');
const isPredicate = (value: Json): boolean => typeof value === 'string' || typeof value === 'boolean';

/** Whether a form can show the value; else it is written as YAML. */
export function fits(kind: FieldKind, value: Json | undefined): boolean {
	if (value === undefined) return kind !== 'yaml';
	if (isPairs(kind)) return pairsFit(kind, value);
	switch (kind) {
		case 'text':
		case 'choice':
		case 'value':
		case 'scalar':
			return isScalar(value);
		case 'scalars':
			return isList(value) && value.every(isScalar);
		case 'number':
			return typeof value === 'number';
		case 'flag':
			return typeof value === 'boolean';
		case 'predicate':
			return isPredicate(value);
		case 'interval':
			return typeof value === 'number' || (isList(value) && value.length === 2 && value.every((each) => typeof each === 'number'));
		case 'texts':
			return isList(value) && value.every((each) => typeof each === 'string');
		case 'predicates':
			return isList(value) && value.every(isPredicate);
		case 'names':
			return isMapping(value) && Object.values(value).every((each) => typeof each === 'string');
		case 'zone':
			return isMapping(value) && Object.values(value).every(isPredicate);
		case 'part':
		case 'parts':
		case 'lists':
			return isMapping(value);
		case 'parameters':
			return areParameters(value);
		case 'yaml':
			return false;
	}
}

/** What the form shows of a value that fits. */
export function shownAs({ kind, otherwise }: FieldShape, value: Json | undefined): Written {
	if (isPairs(kind)) return pairsShown(kind, value);
	switch (kind) {
		case 'scalar':
			return isScalar(value) ? scalarShown(value) : '';
		case 'scalars':
			return isList(value) ? value.map(scalarShown) : [];
		case 'flag':
			return value === undefined ? otherwise === true : value === true;
		case 'interval':
			return isList(value) ? [text(value[0]), text(value[1])] : [text(value), ''];
		case 'texts':
		case 'predicates':
			return isList(value) ? value.map(text) : [];
		case 'names':
		case 'zone':
			return isMapping(value) ? Object.entries(value).map(([name, each]) => [name, text(each)] as const) : [];
		default:
			return text(value);
	}
}

const number = (written: string): number => (written.trim() === '' ? NaN : Number(written.trim().replace(',', '.')));
const truth = (written: string): string | boolean => {
	const bare = written.trim();
	return bare === 'true' ? true : bare === 'false' ? false : bare;
};

/** The value that is written; undefined is none. */
export function readFrom(shape: FieldShape, written: Written): Json | undefined {
	const { kind, required, otherwise, choices } = shape;
	const pairs = (): readonly (readonly [string, string])[] => (Array.isArray(written) ? written : []) as [string, string][];
	const list = (): readonly string[] => (Array.isArray(written) ? written : []) as string[];
	const empty = required ? '' : undefined;
	if (isPairs(kind)) return pairs().length === 0 && !required ? undefined : pairsRead(kind, pairs());
	switch (kind) {
		case 'scalar':
			return String(written) === '' ? undefined : scalarRead(String(written));
		case 'scalars': {
			const found = list().filter((each) => each.trim() !== '').map(scalarRead);
			return found.length === 0 && !required ? undefined : found;
		}
		case 'flag':
			return written === otherwise ? undefined : (written as boolean);
		case 'number':
			return Number.isNaN(number(String(written))) ? undefined : number(String(written));
		case 'choice':
			return choices?.find((choice) => String(choice) === written);
		case 'interval': {
			const [least = '', most = ''] = list();
			if (least.trim() === '') return undefined;
			return most.trim() === '' || number(most) === number(least) ? number(least) : [number(least), number(most)];
		}
		case 'value': {
			const value = truth(String(written));
			if (typeof value === 'boolean') return value;
			return value === '' ? undefined : /^-?\d{1,15}$/.test(value) ? Number(value) : value;
		}
		case 'predicate':
			return truth(String(written)) === '' ? empty : truth(String(written));
		case 'texts':
		case 'predicates': {
			const said = list().map((each) => (kind === 'texts' ? each.trim() : truth(each)));
			const found = said.filter((each) => each !== '');
			return found.length === 0 && !required ? undefined : found;
		}
		case 'names':
		case 'zone': {
			const found = pairs().map(([name, each]) => [name.trim(), kind === 'zone' ? truth(each) : each.trim()] as const);
			return found.length === 0 && !required ? undefined : Object.fromEntries(found);
		}
		default:
			return String(written) === '' ? empty : String(written);
	}
}

/** What is wrong with what is written; null where it is a value. */
export function badValue(shape: FieldShape, written: Written): BadValue | null {
	const { kind, whole, least, above, most } = shape;
	const bad = (said: string): BadValue | null => {
		const value = number(said);
		if (Number.isNaN(value) || !Number.isFinite(value)) return 'number';
		if (whole && !Number.isInteger(value)) return 'whole';
		if ((least !== undefined && value < least) || (above !== undefined && value <= above)) return 'least';
		return most !== undefined && value > most ? 'most' : null;
	};
	if (kind === 'number') return String(written).trim() === '' ? null : bad(String(written));
	if (kind === 'interval' && Array.isArray(written)) {
		const [from, to] = written.map((each) => String(each));
		if (!from?.trim()) return to?.trim() ? 'pair' : null;
		const wrong = bad(from) ?? (to?.trim() ? bad(to) : null);
		return wrong ?? (to?.trim() && number(from) > number(to) ? 'order' : null);
	}
	if (isPairs(kind)) return pairsBad(kind, (Array.isArray(written) ? written : []) as readonly Pair[]);
	if ((kind === 'names' || kind === 'zone') && Array.isArray(written)) {
		const rows = written as readonly (readonly [string, string])[];
		if (rows.some(([name, each]) => !name.trim() || !each.trim())) return 'pair';
		if (!shape.loose && rows.some(([name]) => !/^[A-Za-z_]\w*$/.test(name.trim()))) return 'name';
		return new Set(rows.map(([name]) => name.trim())).size < rows.length ? 'twice' : null;
	}
	if (kind === 'text' && shape.required && String(written).trim() === '') return 'required';
	return null;
}

/** The least and the most of an interval, of which one number says both; null for what is none. */
export function intervalOf(value: Json | undefined): readonly [number, number] | null {
	if (typeof value === 'number') return [value, value];
	const [least, most] = isList(value) ? value : [];
	return typeof least === 'number' && typeof most === 'number' ? [least, most] : null;
}
