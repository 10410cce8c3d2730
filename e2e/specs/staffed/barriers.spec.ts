/** Nothing keeps anybody from any page: all roles, screens and themes, with what opens on demand open. */
import type { Page } from '@playwright/test';
import { findings } from '../../station/barriers.ts';
import { ADA, ERIK, EVA, VERA, type Person } from '../../station/station.ts';
import { DESK, expect, test } from '../../station/test.ts';

const OPERATE = ['/', '/restart', '/state', '/alarms', '/history', '/orders', '/wall'];
/** One page with much in it. */
const MODEL = ['/model', '/model?view=graph', '/model?panel=guards', '/model?ability=robot.move_to_position(home)&panel=runs', '/model?panel=usages&entry=resources%2Frobot.yaml%23measured%23pose'];
const ENGINEER = [...MODEL, '/operations', '/pipelines', '/ros', '/what-if', '/review', '/begin'];
const ADMIN = ['/journal', '/wearables', '/users', '/api-keys', '/webhooks', '/backups', '/storage'];
const WATCH = '/operator';
/** Of each role the pages of its rail, and its own account. */
const ROLES: readonly (readonly [Person, readonly string[]])[] = [
	[VERA, [...OPERATE, '/account']],
	[EVA, [...OPERATE, '/account', WATCH]],
	[ERIK, [...OPERATE, ...ENGINEER, '/account']],
	[ADA, [...OPERATE, ...ENGINEER, ...ADMIN, '/account']]
];
const WIDTHS = [1440, 768, 390, 320];

async function go(page: Page, path: string): Promise<void> {
	await page.goto(path);
	if (path === WATCH) await expect(page.getByRole('heading')).toBeVisible();
	else {
		await expect(page.getByTestId('strip')).toHaveAttribute('data-live', 'true');
		await expect(page.getByRole('heading', { level: 1 })).toBeAttached();
	}
	await page.waitForLoadState('networkidle', { timeout: 3000 }).catch(() => undefined);
}

/** Opens what a button opens, looks, and closes it. */
async function within(page: Page, where: string, open: () => Promise<unknown>): Promise<void> {
	await open();
	await page.waitForTimeout(400); // it fades in: half of it has half of its contrast
	expect.soft(await findings(page), where).toEqual([]);
	await page.keyboard.press('Escape');
}

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

for (const [person, paths] of ROLES)
	test(`axe-core finds nothing on any page of ${person.role} @theme @long`, async ({ browse }) => {
		test.setTimeout(2_400_000);
		const page = await browse(person, '/', DESK);
		for (const path of paths)
			for (const width of path === WATCH ? [...WIDTHS, 192] : WIDTHS) {
				await page.setViewportSize({ width, height: width === 192 ? 192 : 900 });
				await go(page, path);
				expect.soft(await findings(page), `${path} on a screen of ${width}`).toEqual([]);
			}
		for (const width of [1440, 390]) {
			await page.setViewportSize({ width, height: 900 });
			await go(page, '/');
			await within(page, `the palette on a screen of ${width}`, () => page.keyboard.press('Control+k'));
			await within(page, `the keys on a screen of ${width}`, () => page.keyboard.press('?'));
			await within(page, `the account on a screen of ${width}`, () => page.getByTestId('who').click());
			await within(page, `a thing of the picture on a screen of ${width}`, async () => {
				await page.getByTestId('mimic').locator('[role="button"]').first().press('Enter');
				await expect(page.getByRole('dialog')).toBeVisible();
			});
			await go(page, '/state');
			await within(page, `a variable on a screen of ${width}`, async () => {
				await page.locator('[data-row]').filter({ has: page.locator('[data-variable]') }).first().getByRole('button').first().click();
				await expect(page.getByRole('dialog').first()).toBeVisible();
			});
		}
	});
