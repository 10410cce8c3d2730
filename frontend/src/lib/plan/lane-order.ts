import type { StationView } from '#lib/contract.ts';

/**
 * The resources that can do something: people first, then what moves, and last those by which nothing ever moves, such as a
 * planner that is told what the robot holds.
 */
export function laneOrder({ resources, abilities }: Pick<StationView, 'resources' | 'abilities'>): string[] {
	const all = Object.values(abilities);
	const rank = new Map<string, number>();
	for (const { resource, human, moves } of all)
		rank.set(resource, Math.min(rank.get(resource) ?? Infinity, human ? 0 : moves ? 1 : 2));
	return Object.keys(resources)
		.filter((name) => rank.has(name))
		.sort((one, other) => (rank.get(one) ?? 0) - (rank.get(other) ?? 0));
}
