/** The pages that a person can go to, and from which role on. */
import type { Role } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { ACCOUNT, HOME, WATCH } from './way.ts';

export interface Page {
	readonly address: string;
	/** What it is called, in the catalogue. */
	readonly title: keyof Text['pages'];
	/** Who may see it. */
	readonly role: Role;
}

/** Those that the header shows. */
export const MAIN: readonly Page[] = [
	{ address: HOME, title: 'operate', role: 'viewer' },
	{ address: '/restart', title: 'restart', role: 'viewer' },
	{ address: '/state', title: 'state', role: 'viewer' },
	{ address: '/alarms', title: 'alarms', role: 'viewer' },
	{ address: '/history', title: 'history', role: 'operator' },
	{ address: '/ros', title: 'ros', role: 'viewer' },
	{ address: '/model', title: 'model', role: 'viewer' },
	{ address: WATCH, title: 'watch', role: 'viewer' }
];

/** Those below the name of who is signed in. */
export const MENU: readonly Page[] = [
	{ address: ACCOUNT, title: 'account', role: 'viewer' },
	{ address: '/journal', title: 'journal', role: 'operator' },
	{ address: '/watches', title: 'watches', role: 'operator' },
	{ address: '/people', title: 'people', role: 'administrator' },
	{ address: '/keys', title: 'keys', role: 'administrator' }
];

/** The role that the page at `address` needs: the lowest where it is none of these. */
export function roleOf(address: string): Role {
	return [...MAIN, ...MENU].find((page) => page.address === address)?.role ?? 'viewer';
}
