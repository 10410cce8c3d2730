import { expect, test } from 'vitest';
import { browserText } from './browser.ts';

const KHTML = 'AppleWebKit/537.36 (KHTML, like Gecko)';

test.each([
	[`Mozilla/5.0 (Linux; Android 14; SM-R960) ${KHTML} Chrome/141.0.0.0 Mobile Safari/537.36`, 'Chrome 141 on Android'],
	[
		`Mozilla/5.0 (Linux; Android 14) ${KHTML} SamsungBrowser/28.0 Chrome/130.0.0.0 Mobile Safari/537.36`,
		'Samsung Internet 28 on Android'
	],
	[`Mozilla/5.0 (Windows NT 10.0; Win64; x64) ${KHTML} Chrome/141.0.0.0 Safari/537.36 Edg/141.0`, 'Edge 141 on Windows'],
	['Mozilla/5.0 (X11; Linux x86_64; rv:128.0) Gecko/20100101 Firefox/128.0', 'Firefox 128 on Linux'],
	[
		'Mozilla/5.0 (iPhone; CPU iPhone OS 18_5 like Mac OS X) AppleWebKit/605.1.15 Version/18.5 Mobile/15E148 Safari/604.1',
		'Safari 18 on iOS'
	],
	['curl/8.5.0', 'curl/8.5.0'],
	['', 'a browser that does not name itself']
])('%s', (agent, text) => {
	expect(browserText(agent)).toBe(text);
});
