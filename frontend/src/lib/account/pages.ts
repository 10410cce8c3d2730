/** The pages that a person can go to, and from which role on. */
import type { Role } from '#lib/contract.ts';
import { ACCOUNT, HOME, WATCH } from './way.ts';

export interface Page {
	readonly address: string;
	readonly title: string;
	/** Who may see it. */
	readonly role: Role;
}

/** Those that the header shows. */
export const MAIN: readonly Page[] = [
	{ address: HOME, title: 'Operate', role: 'viewer' },
	{ address: WATCH, title: 'Watch', role: 'viewer' }
];

/** Those below the name of who is signed in. */
export const MENU: readonly Page[] = [
	{ address: ACCOUNT, title: 'Account', role: 'viewer' },
	{ address: '/journal', title: 'Journal', role: 'operator' },
	{ address: '/watches', title: 'Watches', role: 'operator' },
	{ address: '/people', title: 'People', role: 'administrator' },
	{ address: '/keys', title: 'Keys', role: 'administrator' }
];

/** The role that the page at `address` needs: the lowest where it is none of these. */
export function roleOf(address: string): Role {
	return [...MAIN, ...MENU].find((page) => page.address === address)?.role ?? 'viewer';
}
