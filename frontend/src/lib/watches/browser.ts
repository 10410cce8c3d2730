/** What a device is called that shows only what its browser calls itself. */
import { say } from '#lib/text/text.svelte.ts';

/** The first that fits wins: what is built upon another names both. */
const BROWSERS: readonly (readonly [RegExp, string])[] = [
	[/\bEdgA?\/(\d+)/, 'Edge'],
	[/\bOPR\/(\d+)/, 'Opera'],
	[/\bSamsungBrowser\/(\d+)/, 'Samsung Internet'],
	[/\b(?:Firefox|FxiOS)\/(\d+)/, 'Firefox'],
	[/\b(?:Chrome|CriOS|HeadlessChrome)\/(\d+)/, 'Chrome'],
	[/\bVersion\/(\d+)[^ ]* .*Safari\//, 'Safari']
];

const SYSTEMS: readonly (readonly [RegExp, string])[] = [
	[/\bAndroid\b/, 'Android'],
	[/\b(?:iPhone|iPad|iPod)\b/, 'iOS'],
	[/\bWatch OS\b|\bwatchOS\b/, 'watchOS'],
	[/\bTizen\b/, 'Tizen'],
	[/\bWindows\b/, 'Windows'],
	[/\bMac OS X\b|\bMacintosh\b/, 'macOS'],
	[/\bCrOS\b/, 'ChromeOS'],
	[/\bLinux\b/, 'Linux']
];

/** `Chrome 141 on Android`, from the header `User-Agent`; as much of that as can be made out, else its own words. */
export function browserText(agent: string): string {
	const browser = BROWSERS.map(([pattern, name]) => {
		const version = pattern.exec(agent)?.[1];
		return version === undefined ? null : `${name} ${version}`;
	}).find((found) => found !== null);
	const system = SYSTEMS.find(([pattern]) => pattern.test(agent))?.[1];
	if (browser === undefined) return agent.trim() === '' ? say().account.watches.nameless : agent;
	return system === undefined ? browser : say().account.watches.browserOn(browser, system);
}
