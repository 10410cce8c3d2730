/**
 * Where stations under test stand: started when a test first asks for one, and kept for those that ask for it later.
 *
 * To start a station takes longer than most tests do, so tests that leave it as usable as they found it share one by
 * name. A test that takes its station apart has one of its own. One that is not asked for still works, and takes its part
 * of the machine, so only the last few are kept.
 */
import { Station, type Options } from './station.ts';

/** How many are kept. */
const MOST = 2;

export class Bench {
	readonly #kept = new Map<string, Station>();
	readonly #given = new Map<string, string>();

	/** The station of that name, started with `options` unless it runs already; an error when it is asked for with others. */
	async kept(name: string, options: Options): Promise<Station> {
		const given = JSON.stringify({ ...options, logs: null });
		if ((this.#given.get(name) ?? given) !== given) throw new Error(`the station “${name}” is shared by tests that want different ones`);
		this.#given.set(name, given);
		const before = this.#kept.get(name);
		this.#kept.delete(name);
		if (!before?.server.running) await before?.stop();
		const station = before?.server.running ? before : await this.#start(options);
		this.#kept.set(name, station);
		return station;
	}

	/** A new one, in the place of the one that was asked for longest ago. */
	async #start(options: Options): Promise<Station> {
		const [oldest] = this.#kept.size < MOST ? [] : this.#kept;
		if (oldest) {
			this.#kept.delete(oldest[0]);
			await oldest[1].stop();
		}
		return Station.start(options);
	}

	/** Stops all; an error when a process had to be forced. */
	async clear(): Promise<void> {
		const ends = await Promise.allSettled([...this.#kept.values()].map((station) => station.stop()));
		this.#kept.clear();
		const failed = ends.find((end) => end.status === 'rejected');
		if (failed) throw failed.reason;
	}
}
