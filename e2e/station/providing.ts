/** The provider of `provider.mjs`, started beside a station and stopped by its input. */
import { spawn, type ChildProcessWithoutNullStreams } from 'node:child_process';
import { join } from 'node:path';
import { createInterface } from 'node:readline';

export const CLIENT = 'station';
export const SECRET = 'a secret of a test alone';

export class Providing {
	readonly #process: ChildProcessWithoutNullStreams;

	private constructor(process: ChildProcessWithoutNullStreams) {
		this.#process = process;
	}

	/** Starts it for the station at `station`; `people` by what they type there, with the claims about them. */
	static async start(port: number, station: string, people: Readonly<Record<string, object>>): Promise<Providing> {
		const started = spawn(process.execPath, [join(import.meta.dirname, 'provider.mjs')]);
		const setup = { port, client: CLIENT, secret: SECRET, station: [station], people, key: 'first' };
		started.stdin.write(`${JSON.stringify(setup)}\n`);
		for await (const line of createInterface({ input: started.stdout })) if (line === 'ready') return new Providing(started);
		throw new Error('the provider has ended');
	}

	/** Ends it. */
	async stop(): Promise<void> {
		const ended = new Promise((resolve) => this.#process.once('exit', resolve));
		this.#process.stdin.end();
		await ended;
	}
}
