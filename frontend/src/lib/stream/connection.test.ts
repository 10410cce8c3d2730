import fc from 'fast-check';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import type { StreamMessage } from '#lib/contract.ts';
import { ENDED, connect, pause, type Listener } from './connection.ts';

/** The part of a browser's WebSocket that the connection uses, driven by the test. */
class Socket {
	static readonly OPEN = 1;
	static all: Socket[] = [];
	static get last(): Socket {
		const socket = Socket.all.at(-1);
		if (socket === undefined) throw new Error('nothing was opened');
		return socket;
	}
	readyState = 0;
	sent: string[] = [];
	closed = false;
	onopen: (() => void) | null = null;
	onmessage: ((event: { data: string }) => void) | null = null;
	onclose: ((event: { code: number }) => void) | null = null;

	constructor(readonly url: string) {
		Socket.all.push(this);
	}
	send(text: string): void {
		this.sent.push(text);
	}
	close(): void {
		this.closed = true;
	}
	open(): void {
		this.readyState = Socket.OPEN;
		this.onopen?.();
	}
}

const listener = { opened: vi.fn(), heard: vi.fn(), closed: vi.fn() } satisfies Listener<StreamMessage>;

beforeEach(() => {
	vi.useFakeTimers();
	vi.stubGlobal('WebSocket', Socket);
	vi.stubGlobal('location', { href: 'http://station/model?entry=a' });
	Socket.all = [];
});
afterEach(() => {
	vi.useRealTimers();
	vi.unstubAllGlobals();
	vi.clearAllMocks();
});

test('the wait between attempts grows, stays below five seconds and never vanishes', () => {
	fc.assert(
		fc.property(fc.nat(1000), fc.double({ min: 0, max: 1, maxExcluded: true, noNaN: true }), (n, chance) => {
			expect(pause(n, chance)).toBeGreaterThanOrEqual(125);
			expect(pause(n, chance)).toBeLessThanOrEqual(5000);
			expect(pause(n + 1, chance)).toBeGreaterThanOrEqual(pause(n, chance));
		})
	);
});

describe('a connection', () => {
	test.each([
		['http://station/model', 'ws://station/api/v1/stream'],
		['https://station:8443/model', 'wss://station:8443/api/v1/stream']
	])('from the page %s is to %s', (page, url) => {
		vi.stubGlobal('location', { href: page });
		const connection = connect('/api/v1/stream', listener);
		expect(Socket.last.url).toBe(url);
		connection.close();
	});

	test('is opened again for ever', () => {
		const connection = connect('/api/v1/stream', listener);
		for (let k = 1; k < 50; k++) {
			Socket.last.onclose?.({ code: 1006 });
			vi.advanceTimersByTime(5000);
			expect(Socket.all).toHaveLength(k + 1);
		}
		connection.close();
	});

	test('on which nothing is heard is given up and opened anew', () => {
		const connection = connect('/api/v1/stream', listener);
		const first = Socket.last;
		first.open();
		vi.advanceTimersByTime(12_000);
		expect(first.closed).toBe(true);
		expect(listener.closed).toHaveBeenCalled();
		expect(Socket.all.length).toBeGreaterThan(1);
		connection.close();
	});

	test('that was given up is not listened to any more', () => {
		const connection = connect('/api/v1/stream', listener);
		const first = Socket.last;
		first.open();
		first.onclose?.({ code: 1006 });
		first.onmessage?.({ data: '{"kind":"error","detail":"late"}' });
		expect(listener.heard).not.toHaveBeenCalled();
		connection.close();
	});

	test('says with which code it was closed', () => {
		const connection = connect('/api/v1/stream', listener);
		Socket.last.open();
		Socket.last.onclose?.({ code: ENDED });
		expect(listener.closed).toHaveBeenCalledWith(ENDED);
		connection.close();
	});

	test('asks for a snapshot only when it is open', () => {
		const connection = connect('/api/v1/stream', listener);
		connection.resync();
		expect(Socket.last.sent).toEqual([]);
		Socket.last.open();
		connection.resync();
		expect(Socket.last.sent).toEqual(['{"kind":"resync"}']);
		connection.close();
	});

	test('is tried again at once where somebody asks for it, and once only', () => {
		const connection = connect('/api/v1/stream', listener);
		Socket.last.open();
		Socket.last.onclose?.({ code: 1006 });
		expect(Socket.all).toHaveLength(1);
		connection.again();
		expect(Socket.all).toHaveLength(2);
		Socket.last.open();
		vi.advanceTimersByTime(5000);
		expect(Socket.all, 'what it waited for is not tried besides').toHaveLength(2);
		connection.again();
		expect(Socket.all.map(({ closed }) => closed), 'one that says nothing more is given up').toEqual([true, true, false]);
		connection.close();
		connection.again();
		expect(Socket.all).toHaveLength(3);
	});

	test('that was closed stays closed', () => {
		connect('/api/v1/stream', listener).close();
		vi.advanceTimersByTime(60_000);
		expect(Socket.all).toHaveLength(1);
	});
});
