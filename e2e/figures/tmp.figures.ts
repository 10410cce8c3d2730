import { writeFileSync } from 'node:fs';
import { ERIK, Station } from '../station/station.ts';
import { test } from '../station/test.ts';
import { opened, prepare, after } from './moments.ts';
test('profile', async ({ browser }) => {
	const station = await Station.start({ byItself: false, devices: false, people: [ERIK], model: '/tmp/large-model', logs: '/tmp/large-logs' });
	try {
		for (let visit = 0; visit < 3; visit++) {
			const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
			await context.addCookies([{ ...(await station.signIn(ERIK)), url: station.url }]);
			const page = await context.newPage();
			await prepare(page);
			const cdp = await context.newCDPSession(page);
			await cdp.send('Performance.enable');
			await cdp.send('Profiler.enable');
			await cdp.send('Profiler.setSamplingInterval', { interval: 500 });
			await cdp.send('Profiler.start');
			const took = await opened(page, `${station.url}/model?entry=resources%2Fmachine_100.yaml%23abilities%23step_1`, { selector: '[role="treeitem"]', text: 'machine_1' });
			const { metrics } = await cdp.send('Performance.getMetrics');
			const m = Object.fromEntries(metrics.map(({ name, value }) => [name, value]));
			const net = await page.evaluate(() => performance.getEntriesByType('resource').map((e) => { const r = e as PerformanceResourceTiming; return [r.name.split('/').slice(3).join('/').slice(-40), Math.round(r.startTime), Math.round(r.responseStart), Math.round(r.responseEnd), r.transferSize]; }));
			const { profile } = await cdp.send('Profiler.stop');
			writeFileSync(`/tmp/large-${visit}.cpuprofile`, JSON.stringify(profile));
			console.log(visit, 'took', took.toFixed(0), 'task', m['TaskDuration'], 'script', m['ScriptDuration'], 'layout', m['LayoutDuration'], 'style', m['RecalcStyleDuration'], 'process', m['ProcessTime']);
			console.log(net.map((each) => each.join(' ')).join('\n'));
			await page.locator('[data-check="done"]').waitFor({ timeout: 100000 });
			await cdp.send('Profiler.start');
			const before = Object.fromEntries((await cdp.send('Performance.getMetrics')).metrics.map(({ name, value }) => [name, value]));
			const chosen = await after(page, { selector: 'h2 .name', text: 'step_3' }, () => page.locator('[role="treeitem"][data-id="resources/machine_100.yaml#abilities#step_3"]').click());
			const now = Object.fromEntries((await cdp.send('Performance.getMetrics')).metrics.map(({ name, value }) => [name, value]));
			writeFileSync(`/tmp/large-c${visit}.cpuprofile`, JSON.stringify((await cdp.send('Profiler.stop')).profile));
			console.log('chosen', chosen, 'task', (now['TaskDuration'] ?? 0) - (before['TaskDuration'] ?? 0), 'script', (now['ScriptDuration'] ?? 0) - (before['ScriptDuration'] ?? 0));
			await context.close();
		}
	} finally { await station.stop(); }
});
