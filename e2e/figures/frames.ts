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

/** What of a page really changes while it is looked at. */
export interface Changing {
	/** How many values were others, one after the other. */
	readonly values: number;
	/** How often such a value became another one, in a second. */
	readonly rate: number;
}

/** Counts, for so many seconds, the texts in `within` that become others. */
export function changesOf(page: Page, within: string, seconds: number): Promise<Changing> {
	return page.evaluate(
		([selector, milliseconds]) =>
			new Promise<Changing>((resolve) => {
				const counts = new Map<Node, number>();
				const observer = new MutationObserver((records) => {
					for (const { target } of records) counts.set(target, (counts.get(target) ?? 0) + 1);
				});
				for (const element of document.querySelectorAll(selector)) observer.observe(element, { characterData: true, subtree: true });
				setTimeout(() => {
					observer.disconnect();
					const all = [...counts.values()].filter((each) => each > 1);
					const whole = all.reduce((sum, each) => sum + each, 0);
					resolve({ values: all.length, rate: all.length === 0 ? 0 : whole / all.length / (milliseconds / 1000) });
				}, milliseconds);
			}),
		[within, seconds * 1000] as const
	);
}

/** Megabytes of JavaScript objects that are still in use. */
export async function heapOf(session: CDPSession): Promise<number> {
	await session.send('HeapProfiler.collectGarbage');
	const { usedSize } = await session.send('Runtime.getHeapUsage');
	return usedSize / 1e6;
}
