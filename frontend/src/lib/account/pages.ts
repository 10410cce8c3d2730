/** The pages that a person can go to, in groups, and from which role on. */
import type { Role } from '#lib/contract.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { ACCOUNT, HOME, REVIEW, WALL, WATCH } from './way.ts';

export interface Page {
	readonly address: string;
	/** What it is called, in the catalogue. */
	readonly title: keyof Text['pages'];
	/** Who may see it. */
	readonly role: Role;
}

export interface Group {
	/** What it is called, in the catalogue. */
	readonly title: keyof Text['frame']['groups'];
	readonly pages: readonly Page[];
}

/** Those of the rail: an operator's, an engineer's, and an administrator's. */
export const GROUPS: readonly Group[] = [
	{
		title: 'operate',
		pages: [
			{ address: HOME, title: 'operate', role: 'viewer' },
			{ address: '/restart', title: 'restart', role: 'viewer' },
			{ address: '/state', title: 'state', role: 'viewer' },
			{ address: '/alarms', title: 'alarms', role: 'viewer' },
			{ address: '/history', title: 'history', role: 'operator' },
			{ address: '/orders', title: 'orders', role: 'viewer' },
			{ address: WALL, title: 'wall', role: 'viewer' }
		]
	},
	{
		title: 'engineer',
		pages: [
			{ address: '/model', title: 'model', role: 'viewer' },
			{ address: '/operations', title: 'operations', role: 'viewer' },
			{ address: '/pipelines', title: 'pipelines', role: 'viewer' },
			{ address: '/ros', title: 'ros', role: 'viewer' },
			{ address: '/what-if', title: 'whatIf', role: 'engineer' },
			{ address: REVIEW, title: 'review', role: 'viewer' }
		]
	},
	{
		title: 'plant',
		pages: [
			{ address: '/journal', title: 'journal', role: 'operator' },
			{ address: '/wearables', title: 'watches', role: 'operator' },
			{ address: '/users', title: 'people', role: 'administrator' },
			{ address: '/api-keys', title: 'keys', role: 'administrator' },
			{ address: '/webhooks', title: 'webhooks', role: 'administrator' },
			{ address: '/backups', title: 'backups', role: 'administrator' },
			{ address: '/storage', title: 'storage', role: 'administrator' }
		]
	}
];

/** Those below the name of who is signed in. */
export const MENU: readonly Page[] = [
	{ address: ACCOUNT, title: 'account', role: 'viewer' },
	{ address: WATCH, title: 'watch', role: 'viewer' }
];

/** Those to which another page leads, and the palette. */
export const WITHIN: readonly Page[] = [{ address: '/begin', title: 'begin', role: 'engineer' }];

const ALL: readonly Page[] = [...GROUPS.flatMap((group) => group.pages), ...MENU, ...WITHIN];

/** The page at `address`, where it is one of these. */
export function pageAt(address: string): Page | undefined {
	return ALL.find((page) => page.address === address);
}

/** The role that the page at `address` needs: the lowest where it is none of these. */
export function roleOf(address: string): Role {
	return pageAt(address)?.role ?? 'viewer';
}
