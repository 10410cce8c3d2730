/** What passes the pipelines of the station that runs: told twice a second, as long as this page looks. */
import type { EdgeFlow, Flows, FlowsMessage, LiveEdge } from '#lib/contract.ts';
import { connect, ENDED } from '#lib/stream/connection.ts';
import type { Station } from '#lib/stream/station.svelte.ts';

/** Seconds after which a record of a topic that declares no deadline counts as old. */
const OLD_AFTER = 5;

/** What passes an edge, and whether it may be taken for what is so now. */
export interface Seen {
	readonly flow: EdgeFlow;
	/** Records a second; null while that is not known. */
	readonly rate: number | null;
	/** Seconds since the last record, or since the topic was heard last where that is older; null before the first. */
	readonly age: number | null;
	readonly isOld: boolean;
}

export class Passing {
	flows = $state.raw<Flows | null>(null);
	live = $state(false);
	readonly #station: Station;

	constructor(station: Station) {
		this.#station = station;
	}

	/** Connects to the server's stream of these pipelines, or of all; the result disconnects. */
	attach(pipelines: readonly string[] | null, ended: () => void): () => void {
		const asked = new URLSearchParams((pipelines ?? []).map((each) => ['pipeline', each]));
		const connection = connect<FlowsMessage>(`/api/v1/pipelines/stream?${asked}`, {
			opened: () => undefined,
			heard: (message) => {
				if (message.kind === 'flows') this.flows = message.flows;
				this.live = message.kind === 'flows';
			},
			closed: (code) => {
				this.live = false;
				if (code === ENDED) ended();
			}
		});
		return () => {
			connection.close();
			this.live = false;
			this.flows = null;
		};
	}

	/** What passes the edge; null where nothing is known of it. */
	at(edge: LiveEdge | null | undefined): Seen | null {
		if (!edge || this.flows === null) return null;
		const pipeline = this.flows.pipelines[edge.pipeline];
		const flow = pipeline?.edges[edge.edge];
		if (!pipeline || !flow) return null;
		const { time } = this.flows;
		const topic = this.#station.view?.topics[edge.pipeline];
		const age = flow.at === null ? null : Math.max(0, time - flow.at);
		// What is said again and again is passed on only once: of a topic that is heard nothing is old.
		const isOld = topic === undefined ? false : topic.direction === 'out' ? false : !topic.fresh;
		const heard = topic?.last ?? null;
		return {
			flow,
			rate: edge.edge === 0 ? pipeline.rate : flow.rate,
			age: isOld && heard !== null ? Math.max(0, time - heard) : age,
			isOld: !this.live || isOld || (topic === undefined && age !== null && age > OLD_AFTER && flow.rate !== 0)
		};
	}
}
