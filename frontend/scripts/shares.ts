/**
 * Which file of scripts a module lies in that several pages need: few files, as each one more takes longer to ask for
 * than to bring, and nothing in them that the watch would bring for others.
 *
 * A file may stand only on those before it, or they import one another in a circle. What two pages need together has all
 * that it needs itself, so these lie one on the other: `core` is what *Operate* and the watch need, `door` what it and the
 * ways in need besides, `frame` the rest of what is around every page of the station, and `operate` what else it shares.
 */
import { resolve } from 'node:path';
import type { Rolldown } from 'vite';

type Asked = Rolldown.ChunkingContext;
type Group = Rolldown.CodeSplittingGroup;

const route = (path: string): string => resolve(import.meta.dirname, '../src/routes', path);
const ROOT = [route('+layout.svelte'), route('+layout.ts')];
const WATCH = [...ROOT, route('operator/+page.svelte')];
const DOOR = [...ROOT, route('sign-in/+page.svelte'), route('setup/+page.svelte')];
const FRAME = [...ROOT, route('(station)/+layout.svelte'), route('(station)/+layout.ts')];
const OPERATE = [...FRAME, route('(station)/+page.svelte')];

/** All modules that come with `pages` at once. */
function needed(pages: readonly string[], asked: Asked): ReadonlySet<string> {
	const found = new Set<string>();
	const open = [...pages];
	for (let id = open.pop(); id !== undefined; id = open.pop()) {
		if (found.has(id)) continue;
		found.add(id);
		open.push(...(asked.getModuleInfo(id)?.importedIds ?? []));
	}
	return found;
}

/** The groups of one build. */
export function shares(): Group[] {
	let known: Record<'watch' | 'door' | 'frame' | 'operate', ReadonlySet<string>> | null = null;
	const layer = (id: string, asked: Asked): string | null => {
		known ??= { watch: needed(WATCH, asked), door: needed(DOOR, asked), frame: needed(FRAME, asked), operate: needed(OPERATE, asked) };
		if (!known.operate.has(id)) return null;
		return known.watch.has(id) ? 'core' : known.door.has(id) ? 'door' : known.frame.has(id) ? 'frame' : 'operate';
	};
	const only = (name: string) => (id: string, asked: Asked) => (layer(id, asked) === name ? name : null);
	return [
		// SvelteKit sets what a document says of the build, such as its version, before its other modules read it at once. So what
		// its first script needs lies in a file that brings nothing else.
		{ name: 'begin', test: /\/kit\/src\/runtime\/client\/payload\.js$|vite\/preload-helper/, priority: 6 },
		{ name: only('core'), priority: 5 },
		{ name: only('door'), priority: 4 },
		{ name: only('frame'), priority: 3 },
		{ name: only('operate'), priority: 2, minShareCount: 2 },
		{ name: 'svelte', test: /node_modules\/svelte\//, priority: 1, entriesAware: true },
		{ name: 'shared', minShareCount: 2, entriesAware: true, entriesAwareMergeThreshold: 1_000 }
	];
}
