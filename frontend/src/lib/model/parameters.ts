/** The parameters of a type of resources: how a form shows them, and the edits that change one. */
import type { Edit } from '#lib/contract.ts';
import { entriesOf, isMapping, textAt, valueAt, type Json } from './content.ts';
import { taken, written } from './making.ts';
import { scalarRead, scalarShown } from './pairs.ts';

/** A parameter as the form shows it; `of` is the range of a value. */
export interface Parameter {
	readonly name: string;
	readonly kind: string;
	readonly of: string;
	readonly otherwise: string;
}

const SECTION = 'parameters';

/** What the kind of a parameter is called that is a value of an enumeration, which it names. */
export const VALUE = 'value';

/** Whether all of them are written as they should be; else they are written as YAML. */
export const areParameters = (value: Json | undefined): boolean =>
	value === undefined ||
	(isMapping(value) && Object.values(value).every((each) => typeof each === 'string' || (isMapping(each) && typeof each['kind'] === 'string')));

/** What is written of each: its kind alone, or more of it. */
export function parametersIn(value: Json | undefined): Parameter[] {
	return entriesOf(value).map(([name, each]) => ({
		name,
		kind: typeof each === 'string' ? each : (textAt(each, ['kind']) ?? ''),
		of: textAt(each, ['of']) ?? '',
		otherwise: scalarShown(valueAt(each, ['default']))
	}));
}

/** What a value can be of: the enumerations that an instance gives, and those of the station. */
export const rangesFor = (parameters: readonly Parameter[], enumerations: readonly string[]): string[] => [
	...parameters.filter(({ kind }) => kind === 'enumeration').map(({ name }) => name),
	...enumerations
];

/** What it is where nothing is given: a text is none that looks like a number, a number is one. */
function defaultFrom({ kind, otherwise }: Parameter): Json | undefined {
	if (otherwise.trim() === '') return undefined;
	if (kind === 'number') return scalarRead(otherwise.replace(',', '.'));
	const bare = scalarRead(otherwise);
	return typeof bare === 'string' ? bare : otherwise.trim();
}

/** Whether what is written can be its default. */
export const isDefault = (parameter: Parameter): boolean =>
	parameter.kind !== 'number' || ['number', 'undefined'].includes(typeof defaultFrom(parameter));

/** The keys of a parameter, as far as something is written behind them. */
function keysOf(parameter: Parameter): Record<string, Json> {
	const otherwise = defaultFrom(parameter);
	return {
		kind: parameter.kind,
		...(parameter.kind === VALUE && { of: parameter.of }),
		...(otherwise !== undefined && { default: otherwise })
	};
}

/** Edits that let a parameter be this; each leaves all else of the file as it is. One that has nothing but its kind is that. */
export function parameterWritten(file: string, content: Json | undefined, parameter: Parameter): Edit[] {
	const at = [SECTION, parameter.name];
	const was = valueAt(content, at);
	const keys = keysOf(parameter);
	if (!isMapping(was)) return written(file, content, at, was, Object.keys(keys).length === 1 ? parameter.kind : keys, 0);
	return ['kind', 'of', 'default'].flatMap((key) => written(file, content, [...at, key], was[key], keys[key], at.length));
}

/** Edits that take a parameter out. */
export const parameterTaken = (file: string, content: Json | undefined, name: string): Edit[] =>
	taken(file, content, [SECTION, name], 0);
