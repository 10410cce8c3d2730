/** A process of the station under test: started with its output kept, stopped by its id, and nothing left behind. */
import { spawn, type ChildProcess } from 'node:child_process';
import { closeSync, mkdirSync, openSync } from 'node:fs';
import { dirname } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { alive, wordsOf, signal, treeOf, type Identity } from './process-tree.ts';

/** Milliseconds that a process and those it started get to end by themselves. */
const GRACE = 15_000;

/** What a test that was given up has left running ends with the process of the tests. */
const left = new Set<ChildProcess>();
process.on('exit', () => {
	for (const child of left) child.kill('SIGTERM');
});

export class StationProcess {
	readonly #child: ChildProcess;
	readonly #ended: Promise<void>;
	readonly log: string;

	/** Starts `command`; what it prints goes to the file `log`. */
	constructor(command: string, args: string[], options: { cwd: string; env: NodeJS.ProcessEnv; log: string }) {
		mkdirSync(dirname(options.log), { recursive: true });
		this.log = options.log;
		const output = openSync(options.log, 'a');
		this.#child = spawn(command, args, { cwd: options.cwd, env: options.env, stdio: ['ignore', output, output] });
		closeSync(output);
		left.add(this.#child);
		this.#ended = new Promise<void>((resolve) => {
			this.#child.once('exit', () => resolve());
			this.#child.once('error', () => resolve());
		}).then(() => void left.delete(this.#child));
	}

	get running(): boolean {
		return this.#child.pid !== undefined && this.#child.exitCode === null && this.#child.signalCode === null;
	}

	/** The process and all it has started. */
	get #tree(): Identity[] {
		return this.running && this.#child.pid !== undefined ? treeOf(this.#child.pid) : [];
	}

	/** Sends a signal to the process and to all it has started. */
	signalTree(name: NodeJS.Signals): void {
		signal(this.#tree, name);
	}

	/** Signals the process among those it has started that runs the command `part`. */
	signalPart(part: string, name: NodeJS.Signals): void {
		// Its name comes before its command; the one that starts the others is called "fork server".
		const commandOf = (words: readonly string[]): string | undefined => words[words.findIndex((word) => word.endsWith('sequence-planner')) + 1];
		const found = this.#tree.slice(1).filter((each) => commandOf(wordsOf(each)) === part);
		const [oldest] = found.sort((one, other) => Number(one.started) - Number(other.started));
		if (oldest === undefined) throw new Error(`no process is the ${part}`);
		signal([oldest], name);
	}

	/** Kills one of the processes that it has started. */
	killPart(part: string): void {
		this.signalPart(part, 'SIGKILL');
	}

	/** Resolves when the process ends by itself, with its exit code; null when a signal ended it. */
	async ended(): Promise<number | null> {
		await this.#ended;
		return this.#child.exitCode;
	}

	/** Asks the process to end. An error when it, or one that it started, has to be ended by force. */
	async stop(): Promise<void> {
		const tree = this.#tree;
		if (this.running) this.#child.kill('SIGTERM');
		const deadline = Date.now() + GRACE;
		while (tree.some(alive) && Date.now() < deadline) await sleep(50);
		const forced = tree.filter(alive);
		signal(forced, 'SIGKILL');
		await this.#ended;
		if (forced.length > 0)
			throw new Error(`${forced.length} of ${tree.length} processes did not end in ${GRACE / 1000} s; see ${this.log}`);
	}

	/** Ends the process and all it has started, at once and without warning. */
	async kill(): Promise<void> {
		this.signalTree('SIGKILL');
		await this.#ended;
	}
}
