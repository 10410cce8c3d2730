/** How smoothly a page is drawn, and how much memory it holds. */
import type { CDPSession, Page } from '@playwright/test';

export interface Frames {
	/** Frames a second, over the whole time. */
	readonly mean: number;
	/** Frames in the worst second. */
	readonly worst: number;
}

/** Counts the frames that the browser draws of `page` for so many seconds. */
export function framesOf(page: Page, seconds: number): Promise<Frames> {
	return page.evaluate(
		(milliseconds) =>
			new Promise<Frames>((resolve) => {
				const began = performance.now();
				const counts: number[] = [];
				const count = (now: number): void => {
					const second = Math.floor((now - began) / 1000);
					counts[second] = (counts[second] ?? 0) + 1;
					if (now - began < milliseconds) requestAnimationFrame(count);
					else {
						const whole = Array.from(counts.slice(0, Math.floor(milliseconds / 1000)), (each) => each ?? 0);
						resolve({ mean: whole.reduce((a, b) => a + b, 0) / whole.length, worst: Math.min(...whole) });
					}
				};
				requestAnimationFrame(count);
			}),
		seconds * 1000
	);
}

/** Megabytes of JavaScript objects that are still in use. */
export async function heapOf(session: CDPSession): Promise<number> {
	await session.send('HeapProfiler.collectGarbage');
	const { usedSize } = await session.send('Runtime.getHeapUsage');
	return usedSize / 1e6;
}
