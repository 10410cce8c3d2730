/** How names and values of the model are said to a person. */
import type { Value } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** `bolt_pair_1` → `bolt pair 1`. */
export function plain(name: string): string {
	return name.replaceAll('_', ' ');
}

/**
 * What a variable is called below the title of its resource: `robot.target_pose` → `target pose`, and
 * `bolts[bolt_pair_1]` → `bolts · bolt pair 1`.
 */
export function variableName(key: string, resource: string | null): string {
	const own = resource !== null && key.startsWith(`${resource}.`) ? key.slice(resource.length + 1) : key;
	return plain(own).replace(/\[([^\]]*)\]/g, ' · $1');
}

/** `true` → `yes`; names lose their underscores; numbers stay. */
export function valueText(value: Value): string {
	if (typeof value === 'boolean') return value ? say().common.yes : say().common.no;
	return typeof value === 'string' ? plain(value) : String(value);
}
