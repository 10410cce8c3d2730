/** Which pages are shown to whom. */
import { GROUPS, type Group } from '#lib/account/pages.ts';
import type { Session } from '#lib/account/session.svelte.ts';

/** The groups with the pages that who is signed in may see; none without a page. */
export function pagesFor(session: Session): readonly Group[] {
	return GROUPS.map((group) => ({ ...group, pages: group.pages.filter((each) => session.may(each.role)) })).filter(
		(group) => group.pages.length > 0
	);
}
