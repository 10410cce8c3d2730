import { signIn, signOut, startProduction } from '../../station/seen.ts';
import { ADA, ADAM, EVA, VERA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';
import type { Page } from '@playwright/test';

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

/** Milliseconds within which a page is left whose session has ended. */
const SOON = { timeout: 2000 };
const STATION = 'Bolt tightening';

/** What belongs to the station: its devices, its work, how it is. */
const WITHIN = ['Robot UR10', 'Nutrunner', 'Place bolt pair', 'Automatic', 'No alarms'];

/** Of the station its title is on the page, below the picture and where one signs in, and nothing else. */
async function expectEmpty(page: Page): Promise<void> {
	await expect(page.getByRole('heading', { name: 'Sign in' })).toBeVisible();
	await expect(page.locator('[data-variable], [data-step], [data-testid="strip"]')).toHaveCount(0);
	await expect(page.getByText(STATION)).toHaveText([`Bolt tightening station · ${new URL(page.url()).host}`, 'Bolt tightening station']);
	for (const each of WITHIN) await expect(page.locator('body')).not.toContainText(each);
	await expect(page).toHaveTitle('Sign in · Sequence Planner');
}

test('who is not signed in sees the title of the station and nothing else, and comes to the page that was asked for', async ({
	browse,
	station
}) => {
	const eva = await browse(null, '/journal');
	await expect(eva).toHaveURL('/sign-in?to=%2Fjournal');
	await expectEmpty(eva);

	const said: string[] = [];
	for (const name of [EVA.name, 'Mallory']) {
		await signIn(eva, name, 'not the password');
		await expect(eva.getByLabel('Password', { exact: true })).toHaveValue('');
		said.push(await eva.getByRole('alert').innerText());
	}
	expect(said[0]).toContain('The name or the password is wrong.');
	expect(said[1]).toBe(said[0]);

	await signIn(eva, EVA.name, EVA.password);
	await expect(eva).toHaveURL('/journal');
	await expect(eva.getByRole('heading', { name: 'Journal' })).toBeVisible();
	await expect(eva).toHaveTitle(/^Bolt tightening station · Journal/);

	// An address that somebody else has made up leads to no other server.
	const hostile = ['https://example.com', '//example.com', '/\\example.com', '/.//example.com', 'javascript:alert(1)'];
	const asked: string[] = [];
	eva.on('request', (request) => asked.push(request.url()));
	for (const to of hostile) {
		await eva.goto(`/sign-in?to=${encodeURIComponent(to)}`);
		await expect(eva).toHaveURL('/');
	}
	expect(asked.filter((url) => new URL(url).host !== new URL(station.url).host)).toEqual([]);
});

test('signing out leaves nothing but the title of the station in sight, neither by Back nor in another tab', async ({ browse }) => {
	const eva = await browse(EVA, '/');
	await expect(eva.getByText(STATION).first()).toBeVisible();
	const other = await eva.context().newPage();
	await other.goto('/wearables');
	await expect(other.getByRole('heading', { name: 'Wearables', exact: true })).toBeVisible();
	await eva.getByTestId('who').click();
	await eva.getByRole('link', { name: 'Journal' }).click();
	await expect(eva.getByRole('heading', { name: 'Journal' })).toBeVisible();

	await signOut(eva);
	await expectEmpty(eva);
	await expectEmpty(other);
	await eva.goBack();
	await expectEmpty(eva);
});

test('a server that starts again does not sign anybody out @long', async ({ browse, station }) => {
	const eva = await browse(EVA, '/');
	await expect(eva.getByTestId('strip')).toHaveAttribute('data-live', 'true');
	station.server.killPart('server');
	await expect(eva.getByTestId('not-live')).toBeVisible(SOON);
	await expect(eva.getByTestId('not-live')).toBeHidden({ timeout: 30_000 });
	await expect(eva.getByTestId('who')).toContainText('Eva');
	await eva.reload();
	await expect(eva.getByTestId('who')).toContainText('Eva');
	await expect(eva.getByTestId('strip')).toHaveAttribute('data-live', 'true');
});

test('an administrator signs somebody out, and that page is left within 2 s', async ({ browse }) => {
	const [ada, adam] = [await browse(ADA, '/users'), await browse(ADAM, '/')];
	await expect(adam.getByText(STATION).first()).toBeVisible();
	await ada.reload();
	await ada.getByRole('button', { name: 'Sign out everywhere: Adam' }).click();
	await ada.getByRole('dialog').getByRole('button', { name: 'Sign out everywhere' }).click();
	await expect(adam).toHaveURL('/sign-in', SOON);
	await expectEmpty(adam);
	await expect(ada.getByRole('status').filter({ hasText: 'Adam is signed out everywhere' })).toBeVisible();
});

test('a viewer looks on and finds nothing to press that acts', async ({ browse }) => {
	const [eva, vera] = [await browse(EVA, '/'), await browse(VERA, '/')];
	await startProduction(eva);
	await expect(eva.getByRole('button', { name: /^Done/ })).toBeVisible({ timeout: 30_000 });
	await expect(vera.getByText('You look on as viewer; an operator acts.')).toBeVisible();
	await expect(vera.getByText('An operator says when it is done.')).toBeVisible();
	await expect(vera.getByTestId('control')).toContainText('Eva');
	for (const name of [/^Done/, /Pause/, /Continue/, /Start production/, /control/])
		await expect(vera.getByRole('button', { name })).toHaveCount(0);

	await vera.getByTestId('who').click();
	await expect(vera.getByRole('link', { name: 'Account' })).toBeVisible();
	for (const [title, role] of [
		['Journal', 'operator'],
		['Wearables', 'operator'],
		['Users', 'administrator'],
		['API keys', 'administrator']
	] as const) {
		await expect(vera.getByRole('link', { name: title })).toHaveCount(0);
		await vera.goto(`/${title.toLowerCase().replace(' ', '-')}`);
		await expect(vera.getByRole('heading', { name: `This page needs the role ${role}` })).toBeVisible();
	}
});
