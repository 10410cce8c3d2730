/** Walls side by side: each stands in a frame of its own, and tells the page around it that it is there. */
import { on } from 'svelte/events';

/** Milliseconds between two signs of life. */
const EVERY = 1000;
const SIGN = 'wall';

/** Whether this page stands within another one. Only walls may, and only of stations that name each other. */
export const FRAMED = typeof window !== 'undefined' && window.parent !== window;

/** Gives the page around this one a sign of life again and again; the result ends that. Says nothing but that. */
export function giveSigns(): () => void {
	const sign = (): void => window.parent.postMessage(SIGN, '*');
	sign();
	const timer = setInterval(sign, EVERY);
	return () => clearInterval(timer);
}

/** Calls `heard` for each sign of life of what stands in `frame`; the result ends that. */
export function hearSigns(frame: HTMLIFrameElement, heard: () => void): () => void {
	return on(window, 'message', ({ source, data }) => {
		if (source === frame.contentWindow && data === SIGN) heard();
	});
}
