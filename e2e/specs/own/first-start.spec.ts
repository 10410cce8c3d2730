import { examine } from '../../station/barriers.ts';
import { signIn } from '../../station/seen.ts';
import { ADA, EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';
import type { Page } from '@playwright/test';

/** The status with which the server answers what a page may send, whatever it shows. */
function post(page: Page, path: string, body: object): Promise<number> {
	return page.evaluate(
		async ([path, body]) => {
			const headers = { 'Content-Type': 'application/json' };
			return (await fetch(path, { method: 'POST', headers, body })).status;
		},
		[`/api/v1/${path}`, JSON.stringify(body)] as const
	);
}

test.use({ shared: null, byItself: false, people: 'nobody' });

test('a new station becomes somebody’s by its link, once, who then lets others in', async ({ station, browse }) => {
	const ada = await browse(null, '/');
	const refusal = ada.getByRole('alert');
	const make = ada.getByRole('button', { name: 'Become the administrator' });

	await test.step('without the link it says where to find it, and offers no demonstration', async () => {
		await expect(ada).toHaveURL('/setup');
		await expect(ada.getByText('Open the link that the station showed on its terminal')).toBeVisible();
		await expect(ada.getByRole('button', { name: /demonstration/ })).toHaveCount(0);
		expect(await post(ada, 'session/demonstration', {})).toBe(403);
	});

	await test.step('a link that somebody made up is refused in words', async () => {
		await ada.goto(`/setup#${'a'.repeat(43)}`);
		await ada.getByLabel('Name').fill(ADA.name);
		await ada.getByLabel('Password', { exact: true }).fill(ADA.password);
		await make.click();
		await expect(refusal).toContainText('This link does not work, or no longer');
		await examine(ada, 'first-start');
	});

	const link = station.link();
	const [, token] = link.split('#') as [string, string];

	await test.step('the link makes the first administrator, and its token is nowhere afterwards', async () => {
		const asked: string[] = [];
		ada.on('request', (request) => asked.push(request.url()));
		await ada.goto(link);
		await expect(make).toBeVisible();
		await expect(ada).toHaveURL('/setup');
		await ada.getByLabel('Name').fill(ADA.name);
		await ada.getByLabel('Password', { exact: true }).fill('Ada');
		await make.click();
		await expect(ada.getByText('The password has 3 characters; it needs at least 12.').last()).toBeVisible();
		await ada.getByLabel('Password', { exact: true }).fill(ADA.password);
		await make.click();
		await expect(ada).toHaveURL('/');
		await expect(ada.getByTestId('who')).toContainText('Ada administrator');

		const devtools = await ada.context().newCDPSession(ada);
		const { entries } = await devtools.send('Page.getNavigationHistory');
		expect([...entries.map((entry) => entry.url), ...asked].filter((url) => url.includes(token))).toEqual([]);
		const kept = await ada.evaluate(() => JSON.stringify([{ ...localStorage }, { ...sessionStorage }, history.state]));
		expect(kept).not.toContain(token);
	});

	await test.step('a second time it makes nobody', async () => {
		const again = await browse(null, link);
		await expect(again.getByText('This station has an administrator already')).toBeVisible();
		await expect(again.getByLabel('Name')).toHaveCount(0);
		const body = { token, name: 'Mallory', password: 'four stolen lanterns' };
		expect(await post(again, 'setup', body)).toBe(403);
	});

	const temporary = await test.step('the administrator adds a person, and hands a password over once', async () => {
		await ada.goto('/users');
		await ada.getByLabel('Name').fill(EVA.name);
		await ada.getByLabel('Role').selectOption('operator');
		const password = await ada.getByLabel('Temporary password').inputValue();
		await ada.getByRole('button', { name: 'Add', exact: true }).click();
		await expect(ada.getByRole('group', { name: 'Temporary password' })).toHaveText(password);
		await examine(ada, 'people');
		await ada.getByRole('button', { name: 'I have handed it over' }).click();
		await expect(ada.getByText(password)).toHaveCount(0);
		await expect(ada.locator('[data-person="Eva"]')).toContainText('with a temporary password');
		return password;
	});

	await test.step('who has a temporary password chooses another one before anything else', async () => {
		const eva = await browse(null, '/');
		await signIn(eva, EVA.name, temporary);
		await expect(eva.getByText('Choose a password of your own first.')).toBeVisible();
		await expect(eva.getByTestId('strip')).toHaveCount(0);
		for (const address of ['/', '/journal', '/operator']) {
			await eva.goto(address);
			await expect(eva).toHaveURL('/account');
			await expect(eva.getByTestId('strip')).toHaveCount(0);
		}
		expect(
			await eva.evaluate(async () => {
				const headers = { 'Content-Type': 'application/json' };
				const answers = await Promise.all([
					fetch('/api/v1/state'),
					fetch('/api/v1/control-lock', { method: 'PUT', headers, body: '{"over":null}' })
				]);
				return answers.map(({ status }) => status);
			})
		).toEqual([403, 403]);

		await eva.getByLabel('Current password').fill(temporary);
		await eva.getByLabel('New password').fill(EVA.password);
		await eva.getByRole('button', { name: 'Change password' }).click();
		await expect(eva.getByText('The password was changed')).toBeVisible();
		await eva.getByRole('link', { name: 'To the station' }).click();
		await expect(eva.getByTestId('who')).toContainText('Eva operator');
		await expect(eva.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	});
});
