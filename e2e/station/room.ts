/** Whether what a page says has room: nothing lies over anything, and nothing is cut that cannot be read elsewhere. */
import type { Page } from '@playwright/test';

/** What the spacing of text may be set to by whoever reads (WCAG 1.4.12). */
const SPACING = '* { line-height: 1.5 !important; letter-spacing: 0.12em !important; word-spacing: 0.16em !important } p { margin-bottom: 2em !important }';

/** What is out of sight is laid out only when it comes into it, and stands anywhere until then. */
const ALL_LAID_OUT = '* { content-visibility: visible !important }';

/** Adds styles to a page, until it is left. */
async function style(page: Page, rules: string): Promise<void> {
	await page.evaluate((text) => {
		const sheet = new CSSStyleSheet();
		sheet.replaceSync(text);
		document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
	}, rules);
}

/** Sets text as widely as a reader may ask for, until the page is left. */
export async function spaceOut(page: Page): Promise<void> {
	await style(page, SPACING);
}

/**
 * What of the text of a page has no room, in words that lead to the place: text that lies over other text, and text that is cut
 * where neither a title says it nor what it is in opens. Drawings are left out, and so is what moves over others on purpose.
 */
export async function crowded(page: Page): Promise<string[]> {
	await style(page, ALL_LAID_OUT);
	return page.evaluate(() => {
		interface Box {
			readonly of: Element;
			readonly layer: Element | null;
			readonly left: number;
			readonly top: number;
			readonly right: number;
			readonly bottom: number;
		}
		const named = (element: Element): string =>
			`${element.tagName.toLowerCase()}.${[...element.classList].filter((each) => !each.startsWith('svelte')).join('.')} "${element.textContent.trim().replace(/\s+/g, ' ').slice(0, 40)}"`;
		const isSeen = (element: Element): boolean =>
			element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) && !element.closest('svg, .unseen, option, noscript');
		/** The layer that an element moves with, above the others. */
		const layerOf = (element: Element | null): Element | null =>
			element === null || ['fixed', 'sticky'].includes(getComputedStyle(element).position) ? element : layerOf(element.parentElement);
		const boxes: Box[] = [];
		const range = document.createRange();
		const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
		while (walker.nextNode()) {
			const of = walker.currentNode.parentElement;
			if (of === null || !walker.currentNode.textContent?.trim() || !isSeen(of)) continue;
			range.selectNodeContents(walker.currentNode);
			for (const rect of range.getClientRects()) {
				let { left, top, right, bottom } = rect;
				for (let around: Element | null = of; around && around !== document.body; around = around.parentElement) {
					const { overflowX, overflowY, clipPath } = getComputedStyle(around);
					if (clipPath.startsWith('inset')) right = left; // it is there for screen readers alone
					if (overflowX === 'visible' && overflowY === 'visible') continue;
					const edge = around.getBoundingClientRect();
					[left, top, right, bottom] = [Math.max(left, edge.left), Math.max(top, edge.top), Math.min(right, edge.right), Math.min(bottom, edge.bottom)];
				}
				if (right - left > 2 && bottom - top > 4) boxes.push({ of, layer: layerOf(of), left, top, right, bottom });
			}
		}
		const found = new Set<string>();
		for (const [number, a] of boxes.entries())
			for (const b of boxes.slice(number + 1)) {
				if (a.of === b.of || a.layer !== b.layer) continue;
				const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
				const height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
				// Boxes of letters are higher than letters: of lines that stand close they touch.
				if (width > 3 && height > 0.4 * Math.min(a.bottom - a.top, b.bottom - b.top)) found.add(`${named(a.of)} lies over ${named(b.of)}`);
			}
		for (const element of document.body.querySelectorAll('*')) {
			const style = getComputedStyle(element);
			const isCut =
				(['hidden', 'clip'].includes(style.overflowX) && element.scrollWidth > element.clientWidth + 1) ||
				(['hidden', 'clip'].includes(style.overflowY) && element.scrollHeight > element.clientHeight + 0.5 * parseFloat(style.fontSize));
			if (!isCut || element.clientWidth < 3 || style.clipPath !== 'none' || !element.textContent.trim() || !isSeen(element)) continue;
			if (element.closest('[title], a, button, summary, [role="button"]') || element.querySelector('[title], a, button, summary')) continue;
			// A face that is scrolled says it once more below.
			const whole = element.textContent.trim();
			const again = [...document.body.querySelectorAll('li')].some((each) => !each.contains(element) && each.textContent.includes(whole) && isSeen(each));
			if (!again) found.add(`${named(element)} is cut`);
		}
		return [...found];
	});
}
