/** When something came about in a page, by the clock of the page itself: what the test adds does not count. */
import type { Page } from '@playwright/test';

/** Milliseconds after which nothing is waited for any more. */
const PATIENCE = 120_000;

/** What pages are given before any script of theirs: the time of the last key or click, and a look after each frame. */
function install(): void {
	const state = { acted: NaN };
	for (const kind of ['keydown', 'pointerdown'] as const)
		addEventListener(kind, (event) => (state.acted = event.timeStamp), { capture: true });
	/** All elements that fit, in shadow roots too. */
	const all = (selector: string, root: ParentNode): Element[] => [
		...root.querySelectorAll(selector),
		...[...root.querySelectorAll('.host')].flatMap(({ shadowRoot }) => (shadowRoot ? all(selector, shadowRoot) : []))
	];
	const seen = (selector: string, text: string, isThere: boolean): boolean =>
		all(selector, document).some((each) => (each.textContent ?? '').includes(text)) === isThere;
	Object.assign(globalThis, { figures: { state, seen } });
}

interface Figures {
	readonly state: { acted: number };
	readonly seen: (selector: string, text: string, isThere: boolean) => boolean;
}

export interface Sought {
	readonly selector: string;
	readonly text?: string;
	/** It goes, where this is false. */
	readonly isThere?: boolean;
}

export async function prepare(page: Page): Promise<void> {
	await page.addInitScript(install);
}

/** Resolves to the time, in ms since the page was called, of the frame after the one that shows it. */
function frameOf(page: Page, { selector, text = '', isThere = true }: Sought): Promise<number> {
	return page.evaluate(
		({ selector, text, isThere, patience }) =>
			new Promise<number>((resolve, reject) => {
				const { seen } = (globalThis as unknown as { figures: Figures }).figures;
				const look = (now: number): void => {
					if (seen(selector, text, isThere)) requestAnimationFrame(() => resolve(performance.now()));
					else if (now > patience) reject(new Error(`${selector} ${text} was not seen`));
					else requestAnimationFrame(look);
				};
				const { now } = performance;
				patience += now.call(performance);
				requestAnimationFrame(look);
			}),
		{ selector, text, isThere, patience: PATIENCE }
	);
}

/** Milliseconds from the call of an address to the frame after the one that shows all of this. */
export async function opened(page: Page, address: string, ...sought: Sought[]): Promise<number> {
	await page.goto(address, { waitUntil: 'commit' });
	return Math.max(...(await Promise.all(sought.map((each) => frameOf(page, each)))));
}

/** Milliseconds from the last key or click of `act` to the frame after the one that shows something. */
export async function after(page: Page, sought: Sought, act: () => Promise<unknown>): Promise<number> {
	const frame = frameOf(page, sought);
	await act();
	const shown = await frame;
	return shown - (await page.evaluate(() => (globalThis as unknown as { figures: Figures }).figures.state.acted));
}

/** How long each key that `act` presses takes to the next frame, in ms (Event Timing, in steps of 8; at least 16). */
export async function keysOf(page: Page, act: () => Promise<unknown>): Promise<number[]> {
	await page.evaluate(() => {
		const longest = new Map<number, number>();
		Object.assign(globalThis, { longest });
		new PerformanceObserver((list) => {
			for (const each of list.getEntries() as (PerformanceEventTiming & { interactionId: number })[])
				if (each.interactionId > 0 && each.name.startsWith('key'))
					longest.set(each.interactionId, Math.max(longest.get(each.interactionId) ?? 0, each.duration));
		}).observe({ type: 'event', durationThreshold: 16 } as PerformanceObserverInit);
	});
	await act();
	await page.waitForTimeout(500);
	return page.evaluate(() => [...(globalThis as unknown as { longest: Map<number, number> }).longest.values()]);
}
