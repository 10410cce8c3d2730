/** What is said beside the name of a page: how many alarms stand, that a restart needs somebody, and what is not deployed, or waits for an approval. */
import { byUrgency, isOver } from '#lib/alarm/priority.ts';
import type { Priority } from '#lib/contract.ts';
import type { Page } from '#lib/account/pages.ts';
import { wantedFor } from '#lib/restart/shown.ts';
import { useStation, type Station } from '#lib/stream/station.svelte.ts';
import { say } from '#lib/text/text.svelte.ts';
import { undeployed } from '#lib/workshop/undeployed.svelte.ts';

export interface Badge {
	readonly text: string;
	/** In words. */
	readonly means: string;
	/** Of the most urgent alarm; null where none stands. */
	readonly priority: Priority | null;
}

/** An approval that is waited for, before changes that are not deployed. */
export function reviewBadge({ waits, changes }: Pick<typeof undeployed, 'waits' | 'changes'>): Badge | null {
	if (waits) return { text: '!', means: say().frame.waits.said(waits.number, waits.name, waits.by), priority: null };
	return changes > 0 ? { text: String(changes), means: say().frame.undeployed(changes), priority: null } : null;
}

class Badges {
	readonly #station: Station;
	readonly #alarms = $derived.by(() => byUrgency(this.#station.view?.alarms ?? {}).filter(([, alarm]) => !isOver(alarm)));
	readonly #wanted = $derived.by(() => (this.#station.view ? wantedFor(this.#station.view).length > 0 : false));

	constructor(station: Station) {
		this.#station = station;
	}

	/** What is said beside the name of `page`; null for nothing, and while nothing is heard. */
	of(page: Page['title']): Badge | null {
		if (!this.#station.live) return null;
		const priority = this.#alarms[0]?.[1].priority ?? null;
		if (page === 'alarms' && this.#alarms.length > 0) {
			return { text: String(this.#alarms.length), means: say().frame.alarms(this.#alarms.length), priority };
		}
		if (page === 'review') return reviewBadge(undeployed);
		return page === 'restart' && this.#wanted ? { text: '!', means: say().restart.notice.wanted, priority } : null;
	}
}

/** Those of the station that the component which asks is about. */
export const badges = (): Badges => new Badges(useStation());
