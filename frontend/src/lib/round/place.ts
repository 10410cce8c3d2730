/** Where on the page a step of the round is about. What is not there is told without being pointed at. */
import { say } from '#lib/text/text.svelte.ts';

/** What the steps are about, one after the other. */
export const THINGS = ['picture', 'plan', 'task', 'stop', 'alarms'] as const;
type Thing = (typeof THINGS)[number];

export function placeOf(thing: Thing): Element | null {
	switch (thing) {
		case 'picture':
			return sectionOf('[data-testid="mimic"]');
		case 'plan':
			return sectionOf('[data-testid="plan-status"]');
		case 'task':
			return sectionOf('button[data-task]') ?? headed(say().watch.forYou);
		case 'stop':
			return document.querySelector('[data-testid="stops"]');
		case 'alarms':
			return document.querySelector('[data-testid="alarm-count"]');
	}
}

function sectionOf(selector: string): Element | null {
	const found = document.querySelector(`main ${selector}`);
	return found?.closest('section') ?? found;
}

function headed(title: string): Element | null {
	const heading = [...document.querySelectorAll('main h2')].find(({ textContent }) => textContent.trim() === title);
	return heading?.closest('section') ?? null;
}
