import type { Locator, Page } from '@playwright/test';
import { examine } from '../../station/barriers.ts';
import { expect, test } from '../../station/test.ts';

const HEARD = ['/smart_nutrunner/state', '/ur10/state', '/ur10/planning_scene/state'];
const row = (page: Page, topic: string): Locator => page.locator(`[data-row="${topic}"]`);
const standing = (page: Page, topic: string): Locator => row(page, topic).locator('[data-standing]');

test('all topics are fresh and have a rate; of a device that falls silent they are named, with what to do @long', async ({
	station,
	operate
}) => {
	await operate.goto(`${station.url}/ros?show=station`);
	for (const topic of HEARD) {
		await expect(standing(operate, topic)).toHaveAttribute('data-standing', 'fresh');
		await expect(row(operate, topic).getByTestId('rate')).toHaveText(/^[1-9][\d.]*\/s$/);
		await expect(row(operate, topic)).toContainText('deadline 1 s');
		await expect(row(operate, topic)).toContainText('/emulated_devices');
	}
	await expect(operate.getByText(/^All \d+ topics of the station are in order/)).toBeVisible();

	await station.fault('robot silent');
	const wrong = operate.getByRole('region', { name: 'What is wrong' });
	await expect(wrong).toContainText('No message for longer than the deadline: Robot UR10');
	await expect(wrong).toContainText('Look after /emulated_devices');
	await expect(standing(operate, '/smart_nutrunner/state')).toHaveAttribute('data-standing', 'fresh');
	await expect(row(operate, '/ur10/state').getByTestId('rate')).toHaveText('0/s');
	await expect(wrong.getByRole('link')).toHaveText(['/ur10/planning_scene/state', '/ur10/state']);

	await wrong.getByRole('link', { name: '/ur10/state' }).click();
	const chosen = operate.getByRole('heading', { name: 'Topic /ur10/state' });
	await expect(chosen).toBeFocused();
	await expect(operate.getByRole('region', { name: 'Topic /ur10/state' })).toContainText('stale');
	await examine(operate, 'ros');

	await station.fault('clear');
	await expect(wrong).toBeHidden();
});
