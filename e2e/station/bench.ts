/**
 * Where stations under test stand: started when a test first asks for one, and kept for those that ask for it later.
 *
 * To start a station takes longer than most tests do, so tests that leave it as usable as they found it share one by
 * name. A test that takes its station apart has one of its own.
 */
import { Station, type Options } from './station.ts';

export class Bench {
	readonly #kept = new Map<string, Station>();

	/** The station of that name, started with `options` unless it runs already. */
	async kept(name: string, options: Options): Promise<Station> {
		const before = this.#kept.get(name);
		if (before?.server.running) return before;
		await before?.stop();
		const station = await Station.start(options);
		this.#kept.set(name, station);
		return station;
	}

	/** Stops all; an error when a process had to be forced. */
	async clear(): Promise<void> {
		const ends = await Promise.allSettled([...this.#kept.values()].map((station) => station.stop()));
		this.#kept.clear();
		const failed = ends.find((end) => end.status === 'rejected');
		if (failed) throw failed.reason;
	}
}
