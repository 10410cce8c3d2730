/** What would keep people from using a page. */
import { AxeBuilder } from '@axe-core/playwright';
import { expect, type Page } from '@playwright/test';
import { picture } from './seen.ts';

/** Screens from a desk to a wrist, in CSS pixels. */
const SCREENS = [
	[1440, 900],
	[768, 1024],
	[320, 640],
	[192, 192]
] as const;

/** What axe-core finds by `rules`, or by all there are, in words that lead to the place. */
export async function findings(page: Page, rules?: string[]): Promise<string[]> {
	const axe = new AxeBuilder({ page });
	const { violations } = await (rules ? axe.withRules(rules) : axe).analyze();
	return violations.flatMap(({ id, help, nodes }) => nodes.map((node) => `${id}: ${help}: ${node.target.join(' ')}`));
}

/**
 * Whatever can be pressed and is smaller in one direction than a finger asks for (44 px), or a mouse (24 px); a box to tick can
 * be pressed at its words.
 */
export async function smallTargets(page: Page): Promise<string[]> {
	return page.evaluate(() => {
		const least = matchMedia('(pointer: coarse)').matches ? 44 : 24;
		return [...document.querySelectorAll('button, a, input:not(.unseen), select, textarea, summary')].flatMap((element) => {
			if (!element.checkVisibility()) return [];
			const { width, height } = (element.closest('label') ?? element).getBoundingClientRect();
			return width >= least && height >= least ? [] : [`${element.textContent.trim()}: ${width} × ${height}`];
		});
	});
}

/** How many pixels of the page lie to the right of the screen, once it has heard how large that is. */
export async function overflow(page: Page): Promise<number> {
	return page.evaluate(async () => {
		for (let frames = 0; frames < 2; frames++) await new Promise(requestAnimationFrame);
		return Math.max(0, document.documentElement.scrollWidth - window.innerWidth);
	});
}

/** The words on a round face that its circle cuts: all that are shown before it is scrolled, on buttons too. */
export async function outsideCircle(watch: Page): Promise<string[]> {
	return watch.evaluate(() => {
		const range = document.createRange();
		const boxes = [...document.querySelectorAll('main :is(h1, p, button)')].flatMap((element) => {
			range.selectNodeContents(element);
			return [...range.getClientRects()].map((box) => ({ text: element.textContent, box }));
		});
		const corner = (x: number, y: number): boolean =>
			Math.hypot(x - innerWidth / 2, y - innerHeight / 2) > innerWidth / 2;
		return boxes
			.filter(({ box }) => [box.left, box.right].some((x) => [box.top, box.bottom].some((y) => corner(x, y))))
			.map(({ text }) => text);
	});
}

/** Looks at a page as it is now, on all screens and in both themes, and keeps pictures. */
export async function examine(page: Page, name: string): Promise<void> {
	for (const [width, height] of SCREENS.toReversed()) {
		await page.setViewportSize({ width, height });
		expect.soft(await overflow(page), `${name}: pixels to the right of a screen of ${width}`).toBe(0);
		expect.soft(await smallTargets(page), `${name}: too small on a screen of ${width}`).toEqual([]);
		await picture(page, `${name}-${width}`, 'light');
	}
	expect.soft(await findings(page), `${name}, light`).toEqual([]);
	await page.emulateMedia({ colorScheme: 'dark' });
	await picture(page, `${name}-${SCREENS[0][0]}`, 'dark');
	expect.soft(await findings(page, ['color-contrast']), `${name}, dark`).toEqual([]);
	await page.emulateMedia({ colorScheme: 'light' });
}
