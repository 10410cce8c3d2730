/**
 * The titles of a model's parts in one language, and documents of the server with them.
 *
 * The server tells titles in English. Whatever it sends has the name of the part beside its title, or above it: where both
 * are those of a part of the model, and only there, the title is told in the language. So what people have written, and
 * what was recorded of another model, stays as it is.
 */
import type { Names } from '#lib/contract.ts';
import { capital } from './capital.ts';

type Words = Readonly<Record<string, string>>;
/** Parts that have titles by language. */
export type PartNames = Pick<Names, 'station' | 'resources' | 'abilities' | 'tasks' | 'operations' | 'specifications' | 'work_masters'>;

/** Lists of the titles of parts, without names. */
const LISTS: ReadonlySet<string> = new Set(['silent', 'failing', 'next_moves', 'moves', 'begins', 'lacks', 'by']);
/** Under which names stand in documents, other than as the key of what has the title. */
const NAMES = ['name', 'ability', 'operation', 'work_master'] as const;
const STATION = 'station';
/** These have names of another kind, and a station may have thousands. */
const UNTITLED = 'variables';

/** Whether a title is no title, but what the part is called in the model: `robot`, `place bolt pair` or `bolt_tightening`. */
function isNameOf(text: string, name: string): boolean {
	const own = name.replace(/[[(].*$/, '').split('.').at(-1) ?? '';
	return text === own || text === own.replaceAll('_', ' ');
}

/** What a document was before it had titles in a language. */
const written = new WeakMap<object, object>();

export class Titles {
	/** By the name of a part and the title that the server tells. */
	readonly #parts = new Map<string, Map<string, string>>();
	readonly #tasks = new Map<string, Map<string, string>>();
	/** By the title alone; null where parts that have it are called otherwise in the language. */
	readonly #alone = new Map<string, string | null>();
	readonly #made = new WeakMap<object, object>();

	constructor(names: PartNames | null, language: string) {
		if (names === null) return;
		this.#learn(this.#parts, { [STATION]: names.station }, language);
		for (const kind of ['resources', 'abilities', 'operations', 'specifications', 'work_masters'] as const)
			this.#learn(this.#parts, names[kind], language);
		this.#learn(this.#tasks, names.tasks, language);
	}

	#learn(into: Map<string, Map<string, string>>, parts: Readonly<Record<string, Words>>, language: string): void {
		for (const [name, words] of Object.entries(parts)) {
			// What has no title of its own is told by its name, and has words to be told apart.
			const told = words[''] ?? words['en'] ?? Object.values(words)[0];
			const title = words[language] ?? told;
			if (told === undefined || title === undefined) continue;
			const known = into.get(name) ?? new Map<string, string>();
			into.set(name, known.set(told, title));
			const before = this.#alone.get(told);
			this.#alone.set(told, before === undefined || before === title ? title : null);
		}
	}

	/** A title that stands alone, as in what was recorded; itself where it is none, or parts that have it are called otherwise. */
	alone(text: string): string {
		return this.#alone.get(text) ?? text;
	}

	/** A document of the server with titles in the language. What has none keeps its identity, and so does what was made once. */
	in<Value>(value: Value): Value {
		return this.#in(value, '') as Value;
	}

	#in(value: unknown, key: string): unknown {
		if (typeof value !== 'object' || value === null) return value;
		const plain = written.get(value) ?? value;
		const before = this.#made.get(plain);
		if (before !== undefined) return before;
		const made = Array.isArray(plain) ? this.#list(plain, key) : this.#object(plain as Readonly<Record<string, unknown>>, key);
		this.#made.set(plain, made);
		if (made !== plain) written.set(made, plain);
		return made;
	}

	#list(list: readonly unknown[], key: string): readonly unknown[] {
		let made: unknown[] | null = null;
		for (const [index, each] of list.entries()) {
			const next = typeof each === 'string' && LISTS.has(key) ? this.alone(each) : this.#in(each, '');
			if (next !== each) (made ??= [...list])[index] = next;
		}
		return made ?? list;
	}

	#object(from: Readonly<Record<string, unknown>>, key: string): Readonly<Record<string, unknown>> {
		let made: Record<string, unknown> | null = null;
		for (const field in from) {
			const each = from[field];
			if (field === UNTITLED) continue;
			const next = typeof each === 'string' ? this.#text(from, key, field, each) : this.#in(each, field);
			if (next !== each) (made ??= { ...from })[field] = next;
		}
		return made ?? from;
	}

	#text(from: Readonly<Record<string, unknown>>, key: string, field: string, text: string): string {
		if (field === 'text') return this.#tasks.get(String(from['ability']))?.get(text) ?? text;
		if (field === STATION && from['kind'] === 'watch') return this.#parts.get(STATION)?.get(text) ?? text;
		if (field !== 'title') return text;
		for (const name of [...NAMES.map((each) => from[each]), key, STATION in from ? STATION : null]) {
			const title = typeof name === 'string' ? this.#parts.get(name)?.get(text) : undefined;
			if (title !== undefined) return title;
			if (typeof name === 'string' && isNameOf(text, name)) return capital(text.replaceAll('_', ' '));
		}
		return text;
	}
}
