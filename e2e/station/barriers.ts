/** What would keep people from using a page. */
import { AxeBuilder } from '@axe-core/playwright';
import type { Page } from '@playwright/test';

/** What axe-core finds, in words that lead to the place. */
export async function findings(page: Page): Promise<string[]> {
	const { violations } = await new AxeBuilder({ page }).analyze();
	return violations.flatMap(({ id, help, nodes }) => nodes.map((node) => `${id}: ${help}: ${node.target.join(' ')}`));
}

/** Whatever can be pressed and is smaller than 44 px in one direction. */
export async function smallTargets(page: Page): Promise<string[]> {
	return page.evaluate(() =>
		[...document.querySelectorAll('button, a, input, select, summary')].flatMap((element) => {
			const { width, height } = element.getBoundingClientRect();
			return width >= 44 && height >= 44 ? [] : [`${element.textContent.trim()}: ${width} × ${height}`];
		})
	);
}

/** How many pixels of the page lie to the right of the screen. */
export async function overflow(page: Page): Promise<number> {
	return page.evaluate(() => Math.max(0, document.documentElement.scrollWidth - window.innerWidth));
}
