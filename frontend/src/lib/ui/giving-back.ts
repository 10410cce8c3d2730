/** Where the focus goes when something that lay over the page is put away. */

/** Gives it back to what had it. Where the page has become another one meanwhile, to what is called the same; else nobody has it. */
export function giveBack(before: Element | null): void {
	const to = before?.isConnected ? before : namesake(before);
	if (to instanceof HTMLElement || to instanceof SVGElement) to.focus({ preventScroll: to !== before });
}

/** The control that has the place of one that is gone. */
function namesake(gone: Element | null): Element | undefined {
	const name = gone?.getAttribute('aria-label') ?? null;
	if (gone === null || name === null) return undefined;
	return [...document.getElementsByTagName(gone.tagName)].find((each) => each.getAttribute('aria-label') === name);
}
