/** Offers of ways back for tests, with what a test is about put in. */
import type { PlanPreview, WayOffer } from '#lib/contract.ts';

/** A plan of so many starts of the robot, one in each tick. */
export function preview(...abilities: string[]): PlanPreview {
	const steps = abilities.map((ability, tick) => {
		return { tick, start: tick, end: tick + 1, ability, title: ability, resource: 'robot', human: false, restart: false, moves: true };
	});
	return { ticks: abilities.length, steps, minimal_ticks: true, minimal_starts: true };
}

export function offer(rest: Partial<WayOffer> = {}): WayOffer {
	return {
		id: 'life-1',
		revision: 7,
		kind: 'replan',
		title: 'Go on as it is',
		title_message: { id: 'offer.nothing-first' },
		physical: [],
		online: [],
		in_service: [],
		assumed: [],
		corrections: [],
		errand: null,
		ends: null,
		ends_message: null,
		into_safe: false,
		operation: null,
		needs_restart: false,
		unsupervised: false,
		at_rest: false,
		breaks: [],
		then: preview('move'),
		goals: ['tighten'],
		left_out: [],
		claims: [],
		records: [],
		only_if_checked: false,
		effort: { cost: 1, corrections: 0, physical: 0, returns: 0, starts: 0, seconds: 1, time: 1 },
		obstacle: null,
		obstacle_message: null,
		...rest
	};
}
