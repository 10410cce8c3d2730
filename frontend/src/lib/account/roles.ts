/** The roles of people, and which includes which. */
import type { Role } from '#lib/contract.ts';

/** From the one that may least; each includes those before it. */
export const ROLES = ['viewer', 'operator', 'engineer', 'administrator'] as const satisfies readonly Role[];

/** Whether who has the role `held` may do what `wanted` may. Nobody's role includes none. */
export function includes(held: Role | null, wanted: Role): boolean {
	return held !== null && ROLES.indexOf(held) >= ROLES.indexOf(wanted);
}
