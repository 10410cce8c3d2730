/**
 * Each page is one prerendered document that is filled in the browser: without the stream there is nothing to show.
 */
export const prerender = true;
export const ssr = false;
