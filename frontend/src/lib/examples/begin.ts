/** What is asked and done so that the draft begins with an example station. */
import type { DraftView, FilesView } from '#lib/contract.ts';
import { STATION } from '#lib/model/tree.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { request, type Answer } from '#lib/rest/request.ts';

const ADDRESS = '/api/v1/model';
/** Milliseconds in which the files of a large model are read or written. */
const PATIENCE = 20_000;

/** What was begun, until the page of the draft tells it. */
let begun: string | null = null;

/** The draft of the station after its change `number`, and its files that an example would take the place of. */
export interface OwnDraft {
	readonly number: number;
	readonly files: readonly string[];
}

/** Whether files are those of a station with nothing but its name. */
export function isBare(files: Readonly<Record<string, { readonly content: unknown } | null>>): boolean {
	const [only, ...others] = Object.entries(files).filter(([, file]) => file !== null);
	const content = only?.[0] === STATION ? only[1]?.content : undefined;
	return others.length === 0 && typeof content === 'object' && content !== null && Object.keys(content).every((key) => key === 'name');
}

/** What of the draft is lost where it begins with an example: no file where it holds nothing but its name. */
export async function ownDraft(): Promise<Answer<OwnDraft>> {
	const known = await request<DraftView>('GET', ADDRESS, { patience: PATIENCE });
	if (!known.ok) return known;
	const { number } = known.value;
	const files = Object.entries(known.value.files).flatMap(([path, { digest }]) => (digest === null ? [] : path));
	if (files.length > 1) return { ...known, value: { number, files } };
	const read = await request<FilesView>('GET', `${ADDRESS}/files?${new URLSearchParams({ path: STATION })}`, { patience: PATIENCE });
	return read.ok ? { ...read, value: { number, files: isBare(read.value.files) ? [] : files } } : read;
}

/** Lets the draft, after its change `number`, become an example; why not, or null. */
export async function beginWith(example: string, number: number, title: string): Promise<Refusal | null> {
	const answer = await request<FilesView>('POST', `${ADDRESS}/begin`, { body: { example, number, title }, patience: PATIENCE });
	if (!answer.ok) return answer.refusal;
	begun = title;
	return null;
}

/** The title of the change by which the draft has just begun with an example, once; null for none. */
export function justBegun(): string | null {
	const title = begun;
	begun = null;
	return title;
}
