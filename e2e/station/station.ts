/**
 * A station under test: server, controller and emulated devices, started as a person starts them.
 *
 * `SEQUENCE_PLANNER` names another executable than the one that `make run` installs.
 */
import { readFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { StationProcess } from './process.ts';

const ROOT = resolve(import.meta.dirname, '../..');
const MODEL = 'models/bolt_tightening';
const EXECUTABLE = process.env['SEQUENCE_PLANNER'] ?? join(ROOT, 'backend/.venv/bin/sequence-planner');
/** Milliseconds until the server must answer. */
const START = 60_000;

export interface Options {
	/** Starts emulated devices with the server and production by itself; else a test does both. */
	readonly byItself: boolean;
	/** Where the output of all processes is kept. */
	readonly logs: string;
}

let stations = 0;

/**
 * A DDS domain that keeps a station apart from all others of this run, and most likely from those of other runs on this
 * machine. Above 100 its ports are those that the system hands out to anybody.
 */
function nextDomain(): number {
	stations += 1;
	return 1 + ((process.pid + stations) % 100);
}

export class Station {
	readonly #env: NodeJS.ProcessEnv;
	readonly #logs: string;
	readonly #started: StationProcess[] = [];
	readonly server: StationProcess;

	private constructor(
		readonly port: number,
		options: Options
	) {
		this.#env = { ...process.env, ROS_DOMAIN_ID: String(nextDomain()) };
		this.#logs = options.logs;
		const alone = options.byItself ? ['--emulator', '--start', '--emulator-speed', '4'] : [];
		this.server = this.#start('server', ['run', MODEL, '--port', String(port), ...alone]);
	}

	/** Starts a station and waits until it answers. */
	static async start(options: Options): Promise<Station> {
		const station = new Station(await freePort(), options);
		try {
			await station.#answers();
		} catch (error) {
			await station.stop();
			throw error;
		}
		return station;
	}

	get url(): string {
		return `http://127.0.0.1:${this.port}`;
	}

	/** Starts emulated devices in a process of their own. */
	emulate(): StationProcess {
		return this.#start('emulator', ['emulate', MODEL]);
	}

	/** The values of all variables as the server knows them, in the words of the page. */
	async values(): Promise<[name: string, value: string][]> {
		const answer = await fetch(`${this.url}/api/v1/state`);
		const { variables } = (await answer.json()) as { variables: Record<string, { value: unknown }> };
		return Object.entries(variables).map(([name, { value }]) => [name, value === null ? 'unknown' : String(value)]);
	}

	/** Moves an emulated device, as somebody might move a real one: `robot.pose := home`. */
	async byHand(change: string): Promise<void> {
		const code = await this.#start('by-hand', ['by-hand', change]).ended();
		if (code !== 0) throw new Error(`${change} by hand ended with ${code}; see ${this.#logs}`);
	}

	/** Stops all that was started; an error when a process had to be forced. */
	async stop(): Promise<void> {
		const ends = await Promise.allSettled(this.#started.map((running) => running.stop()));
		const failed = ends.find((end) => end.status === 'rejected');
		if (failed) throw failed.reason;
	}

	#start(name: string, args: string[]): StationProcess {
		const log = join(this.#logs, `${name}.log`);
		const started = new StationProcess(EXECUTABLE, args, { cwd: ROOT, env: this.#env, log });
		this.#started.push(started);
		return started;
	}

	async #answers(): Promise<void> {
		const deadline = Date.now() + START;
		while (Date.now() < deadline && this.server.running) {
			try {
				const answer = await fetch(`${this.url}/healthz`, { signal: AbortSignal.timeout(2000) });
				if (answer.ok) return;
			} catch {
				// Not listening yet.
			}
			await sleep(200);
		}
		const said = readFileSync(this.server.log, 'utf8').slice(-2000);
		throw new Error(`The station did not start (${EXECUTABLE}). It said:\n${said}`);
	}
}

async function freePort(): Promise<number> {
	const probe = createServer();
	await new Promise<void>((resolve) => probe.listen(0, '127.0.0.1', resolve));
	const address = probe.address();
	await new Promise((resolve) => probe.close(resolve));
	if (address === null || typeof address === 'string') throw new Error('no port was given');
	return address.port;
}
