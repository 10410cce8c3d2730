/** What somebody asks a second person for, in words. */
import type { ApprovedAct, StationView, Value } from '#lib/contract.ts';
import { fullName, valueOf } from '#lib/wording/names.svelte.ts';

/** The variables of an act, each with the value that it is to have. */
export function valuesOf(act: ApprovedAct): readonly (readonly [name: string, value: Value])[] {
	return act.kind === 'force' ? [[act.name, act.value]] : Object.entries(act.values);
}

/** They, as they are called on the page. */
export function actText(view: Pick<StationView, 'resources' | 'variables'> | null, act: ApprovedAct): string {
	return valuesOf(act)
		.map(([name, value]) => `${fullName(view, name)} = ${valueOf(name, value)}`)
		.join(', ');
}
