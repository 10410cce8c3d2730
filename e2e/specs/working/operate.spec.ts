import { findings, overflow } from '../../station/barriers.ts';
import { picture, restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

test('mode, alarms, task and plan are in sight at once, beside Pause and Hold', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	for (const each of [operate.getByTestId('mode'), operate.getByTestId('alarm-count')])
		await expect(each).toBeInViewport({ ratio: 1 });
	for (const name of ['Pause', 'Hold'])
		await expect(operate.getByRole('button', { name, exact: true })).toBeInViewport({ ratio: 1 });
	await expect(operate.getByRole('button', { name: /^Done: Place bolt pair/ })).toBeInViewport({ ratio: 1 });
	await expect(operate.locator('[data-operation], [data-operations]').first()).toBeInViewport({ ratio: 1 });
	const lanes = operate.getByRole('group', { name: 'Plan as lanes' }).getByRole('group');
	await expect(lanes).toHaveCount(4);
	// Its name is as high as the lane, of which only a part is in sight sideways.
	for (const lane of await lanes.all()) await expect(lane.locator('.name')).toBeInViewport({ ratio: 1 });
});

test('on the wall mode, alarms, next start and task are read from afar', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.getByRole('link', { name: 'Wall view' }).click();
	const far = operate.locator('[data-glance]');
	await expect(far).toHaveCount(4);
	for (const each of await far.all()) {
		await expect(each).toBeInViewport({ ratio: 1 });
		const size = await each.evaluate((element) => parseFloat(getComputedStyle(element).fontSize));
		expect(size, `pixels of ${await each.getAttribute('data-glance')}`).toBeGreaterThanOrEqual(40);
	}
	await expect(operate.locator('[data-glance="task"]')).toContainText('Place bolt pair');
	// Nobody touches it: there is no rail, and still Pause and Hold.
	await expect(operate.getByRole('navigation', { name: 'Pages' })).toHaveCount(0);
	await expect(operate.getByRole('button', { name: 'Hold', exact: true })).toBeInViewport({ ratio: 1 });
});

test('what runs ends at the present or after it, what is planned lies after it, and the present stays', async ({
	operate,
	watch
}) => {
	await restsOnPerson(operate, watch);
	const lanes = operate.getByRole('group', { name: 'Plan as lanes' });
	const places = () =>
		lanes.evaluate((all) => {
			const now = all.querySelector('.present')?.getBoundingClientRect().left ?? NaN;
			const blocks = [...all.querySelectorAll<HTMLElement>('[data-step]')].map((block) => {
				const { left, right } = block.getBoundingClientRect();
				return { status: block.dataset['status'], from: left - now, to: right - now };
			});
			return { now, blocks };
		});
	const before = await places();
	for (const { status, from, to } of before.blocks) {
		if (status === 'done') expect(to).toBeLessThanOrEqual(3);
		else if (status === 'running') expect(to).toBeGreaterThanOrEqual(-3);
		else expect(from).toBeGreaterThanOrEqual(-3);
	}
	await operate.waitForTimeout(1000);
	expect((await places()).now).toBe(before.now);
});

test('in forced colours what is active is still told from what is not', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.emulateMedia({ forcedColors: 'active' });
	const edges = await operate
		.locator('[data-operation]')
		.evaluateAll((all) => all.map((each) => [each.classList.contains('active'), getComputedStyle(each).borderLeftWidth]));
	expect(edges).toContainEqual([true, '4px']);
	expect(edges).toContainEqual([false, '0px']);
	await picture(operate, 'operate-forced');
	await operate.emulateMedia({ forcedColors: 'none' });
});

test('why an operation waits is said in words, as often as it is asked @theme', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.getByRole('button', { name: 'Why? New engine' }).click();
	const dialog = operate.getByRole('dialog', { name: 'What “New engine” waits for' });
	await expect(dialog).toContainText(/(is|are) tight/);
	await expect(dialog.locator('[data-involved]').first()).toContainText('Could be changed by');
	await dialog.getByRole('button', { name: 'Ask again' }).click();
	await expect(dialog.getByRole('status').first()).toContainText('As it was at');
	await picture(operate, 'operate-why');
	expect(await findings(operate)).toEqual([]);
	await operate.setViewportSize({ width: 320, height: 640 });
	expect(await overflow(operate)).toBe(0);
	await operate.keyboard.press('Escape');
	await expect(dialog).toBeHidden();
});

test('operations that differ in a pair alone are one row, which opens to each of them', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const operations = operate.getByRole('region', { name: 'Operations' });
	const group = operations.locator('[data-operations="tighten_bolt_pair"]');
	await expect(group.getByRole('button', { name: /\d of 3/ })).toContainText(/(is|are) placed/);
	await expect(group.locator('[data-operation]').first()).toBeHidden();
	await group.getByRole('button', { name: /\d of 3/ }).press('Enter');
	await expect(group.locator('[data-operation]')).toHaveCount(3);
	for (const each of await group.locator('[data-operation]').all()) await expect(each).toBeVisible();
	await expect(group.getByRole('button', { name: 'Why? Tighten bolt pair 1' })).toBeVisible();
	// What people read is no condition of the model.
	await expect(operations).not.toContainText('==');
	expect(await findings(operate)).toEqual([]);
	for (const width of [320, 192]) {
		await operate.setViewportSize({ width, height: 640 });
		expect(await overflow(operate)).toBe(0);
	}
});

test('on a phone the bar stays over the plan, however far the page is scrolled', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	await operate.setViewportSize({ width: 390, height: 400 });
	const name = operate.getByRole('region', { name: 'Plan' }).locator('.lane .name').last();
	await name.evaluate((element) => scrollBy(0, element.getBoundingClientRect().top - 10));
	await expect.poll(async () => (await name.boundingBox())?.y).toBeLessThan(40);
	const over = await name.evaluate((element) => {
		const { left, top, height } = element.getBoundingClientRect();
		return element.contains(document.elementFromPoint(left + 4, top + height / 2));
	});
	expect(over).toBe(false);
});
