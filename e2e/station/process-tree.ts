/**
 * Processes as `/proc` shows them.
 *
 * A process is known by its id *and* the time it was started: an id is given again to another process once its owner has
 * ended, and a test must never signal a process that is not its own.
 */
import { readFileSync, readdirSync } from 'node:fs';

export interface Identity {
	readonly pid: number;
	/** Clock ticks from the start of the system to that of the process. */
	readonly started: string;
}

interface Entry extends Identity {
	readonly parent: number;
}

/** What is known of `pid`; null when there is no such process, or only its remains. */
function entry(pid: number): Entry | null {
	try {
		// The name of the program stands in parentheses and may hold anything; state, parent and the rest follow it.
		const stat = readFileSync(`/proc/${pid}/stat`, 'utf8');
		const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
		const [state, parent, started] = [fields[0], fields[1], fields[19]];
		if (state === 'Z' || parent === undefined || started === undefined) return null;
		return { pid, parent: Number(parent), started };
	} catch {
		return null;
	}
}

/** The process `pid` and all that descend from it; empty when it has ended. */
export function treeOf(pid: number): Identity[] {
	const root = entry(pid);
	if (root === null) return [];
	const all = readdirSync('/proc')
		.filter((name) => /^\d+$/.test(name))
		.flatMap((name) => entry(Number(name)) ?? []);
	const below = (parent: number): Entry[] =>
		all.filter((one) => one.parent === parent).flatMap((one) => [one, ...below(one.pid)]);
	return [root, ...below(pid)];
}

/** The words of its command line, as `ps` shows it; none when it has ended. */
export function wordsOf(identity: Identity): string[] {
	try {
		return readFileSync(`/proc/${identity.pid}/cmdline`, 'utf8').split(/[\0 ]/);
	} catch {
		return [];
	}
}

/** Whether it still runs, and not another in its place. */
export function alive(identity: Identity): boolean {
	return entry(identity.pid)?.started === identity.started;
}

/** Sends `signal` to those of `identities` that still run. */
export function signal(identities: readonly Identity[], name: NodeJS.Signals): void {
	for (const identity of identities) {
		if (!alive(identity)) continue;
		try {
			process.kill(identity.pid, name);
		} catch (error) {
			if ((error as NodeJS.ErrnoException).code !== 'ESRCH') throw error; // it ended just now
		}
	}
}
