/**
 * What an alarm is about, read from its key, which says it (`docs/alarms.md`): `silent:robot`, `overdue:robot.move(p)`,
 * `forced:robot.speed`, `message:/robot/state:cause`.
 */
import type { StationView } from '#lib/contract.ts';

export interface About {
	/** Names of resources. */
	readonly resources: readonly string[];
	/** Topics on which something is to be seen. */
	readonly topics: readonly string[];
	/** Whether what to do is done on the page Restart, also since the state is unsafe because of it. */
	readonly restart: boolean;
}

/** What is read of the station. */
export type Known = Pick<StationView, 'resources' | 'abilities' | 'variables' | 'topics' | 'standing'>;

/** Those whose remedy is a plan, a correction or a decision of a person. */
const RESTART = new Set(['no-plan', 'unsafe-state', 'contradiction', 'undecided-outputs', 'not-restored']);

/** From which an unsafe state can follow, which is a part of them then. */
const LEADS_THERE = new Set(['silent', 'many-silent', 'never-heard', 'still', 'overdue', 'given-up']);

/** What the alarm `key` is about at a station like this. */
export function aboutOf(key: string, station: Known): About {
	const colon = key.indexOf(':');
	const kind = colon < 0 ? key : key.slice(0, colon);
	const rest = colon < 0 ? '' : key.slice(colon + 1);
	const about = (resources: readonly (string | null | undefined)[], topics: readonly string[] = []): About => ({
		resources: [...new Set(resources)].filter((name) => name != null && Object.hasOwn(station.resources, name)) as string[],
		topics,
		restart: RESTART.has(kind) || (LEADS_THERE.has(kind) && station.standing === 'stopped')
	});
	switch (kind) {
		case 'silent':
			return about([rest], troubled(station, (topic) => topic.resource === rest && topic.direction === 'in' && !topic.fresh));
		case 'network':
			return about([rest], troubled(station, (topic) => topic.resource === rest && topic.trouble !== null));
		case 'still':
		case 'by-hand':
		case 'given-up':
			return about([rest]);
		case 'overdue':
		case 'tried':
			return about([station.abilities[rest]?.resource]);
		case 'forced':
			return about([station.variables[rest]?.resource]);
		case 'conflict':
			return about(rest.split(':').map((name) => station.abilities[name]?.resource ?? station.variables[name]?.resource));
		case 'message': {
			const place = Object.keys(station.topics).find((name) => rest.startsWith(`${name}:`));
			return about([place === undefined ? null : station.topics[place]?.resource], place === undefined ? [] : [place]);
		}
		case 'never-heard':
		case 'many-silent': {
			const topics = troubled(station, (topic) => !topic.fresh && topic.direction === 'in');
			return about(topics.map((name) => station.topics[name]?.resource), topics);
		}
		case 'rival':
		case 'command': {
			const topics = troubled(station, (topic) => topic.direction === 'out' && topic.trouble !== null);
			return about(topics.map((name) => station.topics[name]?.resource), topics);
		}
		default:
			return about([]);
	}
}

function troubled(station: Known, is: (topic: Known['topics'][string]) => boolean): string[] {
	return Object.keys(station.topics).filter((name) => {
		const topic = station.topics[name];
		return topic !== undefined && is(topic);
	});
}
