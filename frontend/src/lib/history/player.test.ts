import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import type { Place, TimeLine } from '#lib/contract.ts';
import type { History } from './history.svelte.ts';
import { Player } from './player.svelte.ts';

/** A past with a record each second from 100 to 130. */
class Past {
	line = { first: { number: 100, time: 100 }, last: { number: 130, time: 130 } } as TimeLine;
	window = { from: 110, to: 130 };
	place: Place | null = null;
	moment: { record: { number: number } } | null = null;
	momentRefusal = null;
	/** Milliseconds until it is told how the station was. */
	slow = 0;
	readonly asked: number[] = [];

	chooseAt(time: number): Promise<void> {
		this.asked.push(time);
		this.place = { number: Math.floor(time), time: Math.floor(time) };
		const { number } = this.place;
		setTimeout(() => (this.moment = { record: { number } }), this.slow);
		return Promise.resolve();
	}
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

function playing(past: Past, speed: number): Player {
	const player = new Player(past as unknown as History);
	player.speed = speed;
	player.toggle();
	return player;
}

describe('the past runs on', () => {
	test('from the chosen moment, as fast as is wanted', async () => {
		const past = new Past();
		past.place = { number: 112, time: 112 };
		const player = playing(past, 4);
		await vi.advanceTimersByTimeAsync(3100);
		expect(past.asked[0]).toBe(112);
		expect(past.place.time).toBeGreaterThanOrEqual(122);
		expect(past.place.time).toBeLessThanOrEqual(125);
		expect([...past.asked].sort((a, b) => a - b)).toEqual(past.asked);
		player.stop();
		const asked = past.asked.length;
		await vi.advanceTimersByTimeAsync(3000);
		expect(past.asked.length).toBe(asked);
	});

	test('from the beginning of what is in sight where nothing is chosen, and stops at its end', async () => {
		const past = new Past();
		const player = playing(past, 16);
		await vi.advanceTimersByTimeAsync(10_000);
		expect(past.asked[0]).toBe(110);
		expect(past.place?.number).toBe(130);
		expect(player.time).toBeNull();
	});

	test('no further than the moment that is shown', async () => {
		const past = new Past();
		past.place = { number: 112, time: 112 };
		past.slow = 900;
		const player = playing(past, 4);
		for (let looks = 0; looks < 100 && player.time !== null; looks++) {
			await vi.advanceTimersByTimeAsync(100);
			if (player.time !== null) expect(player.time - (past.moment?.record.number ?? 112)).toBeLessThanOrEqual(1);
		}
		expect(past.place.time).toBeGreaterThan(116);
	});

	test('no longer when somebody has chosen another moment', async () => {
		const past = new Past();
		const player = playing(past, 1);
		await vi.advanceTimersByTimeAsync(1000);
		past.place = { number: 120, time: 120 };
		await vi.advanceTimersByTimeAsync(1000);
		expect(player.time).toBeNull();
		expect(past.place.number).toBe(120);
	});
});
