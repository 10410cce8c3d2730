/** Stages as they go through the clipboard: YAML, as files have them. */
import type { Json } from '#lib/contract.ts';
import { asJson, isMapping } from '#lib/model/content.ts';
import { PARTS } from '#lib/model/documents.ts';

/** A stage as it would be written in a list of stages. */
export async function textOf(stage: Json): Promise<string> {
	const { stringify } = await import('yaml');
	return stringify([stage]);
}

/** The stages that a text has, one or a list of them; null where it has something else. */
export async function stagesIn(text: string): Promise<readonly Json[] | null> {
	const { parse } = await import('yaml');
	let read: unknown;
	try {
		read = parse(text);
	} catch {
		return null;
	}
	const all: unknown[] = Array.isArray(read) ? read : [read];
	return all.length > 0 && all.every(isStage) ? (all as Json[]) : null;
}

function isStage(value: unknown): boolean {
	if (!isMapping(asJson(value as Json))) return false;
	const kinds = Object.keys(value as object);
	return kinds.length === 1 && kinds.every((kind) => kind in (PARTS['stage']?.fields ?? {}));
}
