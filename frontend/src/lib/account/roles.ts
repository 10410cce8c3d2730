/** What the roles of people are called, and which includes which. */
import type { Role } from '#lib/contract.ts';

/** From the one that may least; each includes those before it. */
export const ROLES = ['viewer', 'operator', 'engineer', 'administrator'] as const satisfies readonly Role[];

/** Whether who has the role `held` may do what `wanted` may. Nobody's role includes none. */
export function includes(held: Role | null, wanted: Role): boolean {
	return held !== null && ROLES.indexOf(held) >= ROLES.indexOf(wanted);
}

/** What each role is called and what it lets a person do. */
export const ROLE: Record<Role, { readonly name: string; readonly may: string }> = {
	viewer: { name: 'viewer', may: 'looks, and acts on nothing' },
	operator: { name: 'operator', may: 'runs the station, does tasks and pairs watches' },
	engineer: { name: 'engineer', may: 'runs the station and attaches to its ROS graph' },
	administrator: { name: 'administrator', may: 'does all that an engineer does, and decides who may do what' }
};
