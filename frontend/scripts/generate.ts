/**
 * Writes what is generated: `src/lib/api.ts`, the types of the REST interface, from `openapi.json`, and
 * `src/lib/model/documents.ts`, what the documents of a model may hold, from the JSON Schemas in `docs/schemas`.
 *
 * Builds, checks and tests run it first, also beside one another: a file is replaced whole, and only where it differs.
 */
import { existsSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import openapiTS, { astToString, COMMENT_HEADER } from 'openapi-typescript';
import type { FieldShape, PartShape } from '../src/lib/model/shape.ts';

interface Schema {
	readonly $ref?: string;
	readonly $defs?: Readonly<Record<string, Schema>>;
	readonly type?: string;
	readonly description?: string;
	readonly properties?: Readonly<Record<string, Schema>>;
	readonly required?: readonly string[];
	readonly additionalProperties?: Schema | boolean;
	readonly anyOf?: readonly Schema[];
	readonly oneOf?: readonly Schema[];
	readonly items?: Schema;
	readonly prefixItems?: readonly Schema[];
	readonly enum?: readonly (string | number)[];
	readonly default?: unknown;
	readonly unit?: 's';
	readonly minimum?: number;
	readonly exclusiveMinimum?: number;
	readonly maximum?: number;
	readonly minItems?: number;
	readonly maxItems?: number;
}

const FOLDER = join(import.meta.dirname, '../../docs/schemas');
const INTERFACE = join(import.meta.dirname, '../openapi.json');
const LIBRARY = join(import.meta.dirname, '../src/lib');
// What is in a type may be a parameter; where others have a part of the same name, it is theirs that has a form.
const FILES = ['type', 'instance', 'station', 'resource', 'operations', 'specifications', 'work_masters'];
const HEAD = `/** What the documents of a model may hold. Made by \`scripts/generate.ts\` from \`docs/schemas\`: do not edit. */
import type { PartShape } from './shape.ts';

export const PARTS: Readonly<Record<string, PartShape>> = `;

/** \`AbilityDocument\` is the part \`ability\`. */
const partName = (reference: string): string =>
	(reference.split('/').at(-1) ?? '')
		.replace(/Document$/, '')
		.replace(/(?<=[a-z])(?=[A-Z])/g, '_')
		.toLowerCase();

const isText = (schema: Schema | undefined): boolean => schema?.type === 'string' && schema.enum === undefined;
const isPredicate = (schema: Schema | undefined): boolean =>
	schema?.anyOf?.map((each) => each.type).join() === 'string,boolean';

const isScalar = (schema: Schema | undefined): boolean =>
	schema?.anyOf?.map((each) => each.type).join() === 'string,boolean,integer,number';
/** A value of a variable. */
const isValue = (schema: Schema | undefined): boolean =>
	schema?.anyOf?.map((each) => each.type).join() === 'boolean,integer,string';
/** What a parameter of a type of resources is given. */
const isArgument = (schema: Schema | undefined): boolean =>
	schema?.anyOf?.map((each) => each.type).join() === 'string,integer,number';
/** A list of numbers, some of which may be missing. */
const isNumbers = (schema: Schema | undefined): boolean =>
	schema?.type === 'array' && (schema.items?.type === 'number' || schema.prefixItems !== undefined);
/** A list of pairs, each side of which is a name or several. */
const isCouples = (schema: Schema): boolean =>
	schema.type === 'array' && schema.items?.type === 'array' && schema.items.items?.anyOf?.map((each) => each.type).join() === 'string,array';
/** What a definition is called that is written in a way of its own. */
const refersTo = (schema: Schema | undefined, name: string): boolean => schema?.$ref?.endsWith(`/${name}Document`) ?? false;

/** A text for people; where it is written by language, it is a mapping, which a form has as it is written. */
const isTold = (schema: Schema): boolean =>
	schema.oneOf?.length === 2 && isText(schema.oneOf[0]) && refersTo(schema.oneOf[1], 'Words');

function kindOf(schema: Schema): Pick<FieldShape, 'kind' | 'part' | 'choices'> {
	const within = typeof schema.additionalProperties === 'object' ? schema.additionalProperties : undefined;
	if (refersTo(within, 'Bounds')) return { kind: 'bounds' };
	if (refersTo(schema.items, 'TableRow')) return { kind: 'rows' };
	const kinds = within?.anyOf?.some((each) => refersTo(each, 'Parameter')) ? within.anyOf.find((each) => each.enum)?.enum : undefined;
	if (kinds !== undefined) return { kind: 'parameters', choices: kinds };
	if (isScalar(schema)) return { kind: 'scalar' };
	if (schema.type === 'array' && isScalar(schema.items)) return { kind: 'scalars' };
	if (isScalar(within) || isValue(within) || isArgument(within) || schema.additionalProperties === true) return { kind: 'named' };
	if (isNumbers(within)) return { kind: 'numbers' };
	if (isCouples(schema)) return { kind: 'couples' };
	if (schema.$ref !== undefined) return { kind: 'part', part: partName(schema.$ref) };
	if (schema.enum !== undefined) return { kind: 'choice', choices: schema.enum };
	if (isPredicate(schema)) return { kind: 'predicate' };
	if (schema.type === 'string' || isTold(schema)) return { kind: 'text' };
	if (schema.type === 'boolean') return { kind: 'flag' };
	if (schema.type === 'number' || schema.type === 'integer') return { kind: 'number' };
	if (schema.type === 'array' && isText(schema.items)) return { kind: 'texts' };
	if (schema.type === 'array' && isPredicate(schema.items)) return { kind: 'predicates' };
	if (within?.$ref !== undefined) return { kind: 'parts', part: partName(within.$ref) };
	if (within?.type === 'array' && isText(within.items)) return { kind: 'lists' };
	if (isText(within)) return { kind: 'names' };
	if (isPredicate(within)) return { kind: 'zone' };
	const ways = schema.anyOf ?? [];
	const choice = ways.find((each) => each.enum !== undefined);
	if (choice?.enum !== undefined) return { kind: 'choice', choices: choice.enum };
	if (ways.map((each) => each.type).join() === 'number,array') return { kind: 'interval' };
	if (isValue(schema)) return { kind: 'value' };
	return { kind: 'yaml' };
}

function fieldOf(schema: Schema, required: boolean): FieldShape {
	const bound = schema.anyOf?.find((each) => each.type === 'number') ?? schema;
	const isScalar = ['string', 'number', 'boolean'].includes(typeof schema.default);
	return {
		...kindOf(schema),
		help: (schema.description ?? '').replaceAll(/\s+/g, ' '),
		required,
		...(isScalar && { otherwise: schema.default as string | number | boolean }),
		...(schema.maxItems !== undefined && schema.maxItems === schema.minItems && { count: schema.maxItems }),
		...(schema.type === 'integer' && { whole: true }),
		...(bound.unit !== undefined && { unit: bound.unit }),
		...(bound.minimum !== undefined && { least: bound.minimum }),
		...(bound.exclusiveMinimum !== undefined && { above: bound.exclusiveMinimum }),
		...(bound.maximum !== undefined && { most: bound.maximum })
	};
}

function partOf(schema: Schema): PartShape {
	const fields = Object.entries(schema.properties ?? {}).map(
		([name, field]) => [name, fieldOf(field, schema.required?.includes(name) ?? false)] as const
	);
	return { about: (schema.description ?? '').replaceAll(/\s+/g, ' '), fields: Object.fromEntries(fields) };
}

const parts: Record<string, PartShape> = {};
for (const file of FILES) {
	const schema = JSON.parse(readFileSync(join(FOLDER, `${file}.schema.json`), 'utf8')) as Schema;
	if (schema.properties) parts[file] = partOf(schema);
	for (const [name, each] of Object.entries(schema.$defs ?? {}))
		if (!/Example/.test(name)) parts[partName(name)] = partOf(each);
}
/** These parts and all that are below them. */
function within(names: readonly string[]): Set<string> {
	const found = new Set(names);
	for (const name of found)
		for (const field of Object.values(parts[name]?.fields ?? {})) if (field.part !== undefined) found.add(field.part);
	return found;
}
// Only what a form is made of. What stages name are fields of messages, which may be paths, and their texts.
const stages = within(['stage']);
const used = within(['station', 'enumeration', 'predicate', 'resource', 'instance', 'type', 'operation', 'sequence', 'specification', 'work_master', 'stage']);
const loosened = (field: FieldShape): FieldShape =>
	field.kind === 'names' ? { ...field, loose: true } : field.kind === 'lists' ? { ...field, kind: 'words' } : field;
const kept = Object.fromEntries(
	Object.entries(parts)
		.filter(([name]) => used.has(name))
		.map(([name, { about, fields }]) => {
			const all = Object.entries(fields).map(([key, field]) => [key, stages.has(name) ? loosened(field) : field] as const);
			return [name, { about, fields: Object.fromEntries(all) }];
		})
);

function put(path: string, text: string): void {
	const target = join(LIBRARY, path);
	if (existsSync(target) && readFileSync(target, 'utf8') === text) return;
	const unfinished = `${target}.${String(process.pid)}`;
	writeFileSync(unfinished, text);
	renameSync(unfinished, target);
}

put('api.ts', COMMENT_HEADER + astToString(await openapiTS(readFileSync(INTERFACE, 'utf8'))));
put('model/documents.ts', `${HEAD}${JSON.stringify(kept, null, '\t')};\n`);
