/**
 * A plugin that ends the build where files of scripts import one another in a circle: one of them would run before what
 * it needs is there, and no page would come up in a browser.
 */
import type { Plugin } from 'vite';

/** The first circle that is found from `file` on, as the files in it; null where there is none. */
function circle(file: string, imports: ReadonlyMap<string, readonly string[]>, done: Set<string>, way: readonly string[] = []): string[] | null {
	if (way.includes(file)) return [...way.slice(way.indexOf(file)), file];
	if (done.has(file)) return null;
	for (const next of imports.get(file) ?? []) {
		const found = circle(next, imports, done, [...way, file]);
		if (found) return found;
	}
	done.add(file);
	return null;
}

export function noCycles(): Plugin {
	return {
		name: 'no-cycles',
		applyToEnvironment: ({ name }) => name === 'client',
		generateBundle(_, bundle) {
			const files = Object.values(bundle).flatMap((each) => (each.type === 'chunk' ? [each] : []));
			const imports = new Map(files.map((each) => [each.fileName, each.imports]));
			const done = new Set<string>();
			for (const file of imports.keys()) {
				const found = circle(file, imports, done);
				if (!found) continue;
				const of = new Map(files.map((each) => [each.fileName, each.moduleIds.map((id) => id.replace(/^.*\/(src|node_modules)\//, ''))]));
				const said = found.slice(1).map((each) => `\n${each}: ${(of.get(each) ?? []).join(', ')}`);
				this.error(`Scripts import one another in a circle: ${found.join(' → ')}. See codeSplitting in vite.config.ts.${said.join('')}`);
			}
		}
	};
}
