/**
 * The WebSocket to the server: opened again for ever, with a growing wait between attempts.
 *
 * A connection can die without a word (a laptop that slept, a server that stopped), so one on which nothing is
 * heard for `SILENT` is closed and opened anew.
 */
import type { Resync, StreamMessage } from '#lib/contract.ts';

const SHORTEST = 250;
const LONGEST = 5000;
const SILENT = 6000;

/** Milliseconds before attempt `n` (from 0). `chance` in [0, 1) spreads the clients of a server that comes back. */
export function pause(n: number, chance: number): number {
	const wait = Math.min(LONGEST, SHORTEST * 2 ** Math.min(n, 16));
	return wait * (0.5 + chance / 2);
}

/** The code with which the server closes a stream whose session, key or watch has ended. */
export const ENDED = 4401;
/** What is told of a connection that this page gave up itself: the browser's own code for "no reason was heard". */
const NO_WORD = 1006;

export interface Listener<Message> {
	opened(): void;
	heard(message: Message): void;
	/** It is closed, with the WebSocket's code; it will be tried again. */
	closed(code: number): void;
}

export interface Connection {
	/** Asks for a new snapshot. */
	resync(): void;
	/** Connects anew at once, whatever it waits for. */
	again(): void;
	close(): void;
}

/** One that is closed before it is open would be complained of in the browser's console. */
function close(socket: WebSocket): void {
	if (socket.readyState === WebSocket.CONNECTING) socket.onopen = () => socket.close();
	else socket.close();
}

/** Where the browser finds a stream of the server that this page is from. */
function streamAddress(path: string): string {
	const url = new URL(path, location.href);
	url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
	return url.href;
}

/**
 * Connects to the server's stream at `path`, where each message is a `Message` in JSON, and keeps connecting until
 * `close`. After `silent` milliseconds in which nothing was heard it connects anew.
 */
export function connect<Message = StreamMessage>(
	path: string,
	listener: Listener<Message>,
	silent = SILENT
): Connection {
	const url = streamAddress(path);
	let socket: WebSocket | null = null;
	let attempts = 0;
	let retry: ReturnType<typeof setTimeout> | undefined;
	let watch: ReturnType<typeof setTimeout> | undefined;
	let ended = false;

	function heardSomething(): void {
		clearTimeout(watch);
		watch = setTimeout(() => drop(NO_WORD), silent);
	}

	function drop(code: number): void {
		clearTimeout(watch);
		const dead = socket;
		socket = null;
		if (dead === null) return;
		close(dead);
		listener.closed(code);
		if (!ended) retry = setTimeout(open, pause(attempts++, Math.random()));
	}

	function open(): void {
		const opening = new WebSocket(url);
		socket = opening;
		heardSomething();
		opening.onopen = () => {
			if (socket === opening) listener.opened();
		};
		opening.onmessage = (event: MessageEvent<string>) => {
			if (socket !== opening) return;
			heardSomething();
			attempts = 0;
			listener.heard(JSON.parse(event.data) as Message);
		};
		opening.onclose = (event: CloseEvent) => {
			if (socket === opening) drop(event.code);
		};
	}

	open();
	return {
		resync() {
			const message: Resync = { kind: 'resync' };
			if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
		},
		again() {
			if (ended) return;
			drop(NO_WORD);
			clearTimeout(retry);
			attempts = 0;
			open();
		},
		close() {
			ended = true;
			clearTimeout(retry);
			drop(NO_WORD);
		}
	};
}
