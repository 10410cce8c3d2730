import { rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { examine } from '../../station/barriers.ts';
import { ADA, EVA } from '../../station/station.ts';
import { expect, test } from '../../station/test.ts';

test.use({ shared: 'staffed', byItself: false, devices: true, people: 'everybody' });

test('a key is made, its secret is shown once, it gets another, and revoked it opens nothing', async ({ browse, station }) => {
	const ada = await browse(ADA, '/api-keys');
	const read = async (secret: string): Promise<number> =>
		(await fetch(`${station.url}/api/v1/state`, { headers: { Authorization: `Bearer ${secret}` } })).status;
	await ada.getByLabel('Name of the system that uses it').fill('Dashboard');
	await ada.getByRole('button', { name: 'Make', exact: true }).click();
	const secret = await ada.getByRole('group', { name: 'Secret', exact: true }).innerText();
	expect(secret).toMatch(/^sp_/);
	expect(await read(secret)).toBe(200);
	await examine(ada, 'keys');
	await ada.getByRole('button', { name: 'I have kept it' }).click();
	await expect(ada.getByText(secret)).toHaveCount(0);
	await ada.reload();
	await expect(ada.locator('[data-key="Dashboard"]')).toContainText('valid');
	await expect(ada.getByText(secret)).toHaveCount(0);

	await ada.getByRole('button', { name: 'New secret for Dashboard' }).click();
	const dialog = ada.getByRole('dialog');
	await dialog.getByRole('button', { name: 'New secret' }).click();
	const next = await dialog.getByRole('group', { name: 'Secret', exact: true }).innerText();
	expect([await read(secret), await read(next)]).toEqual([200, 200]);
	await examine(ada, 'key-rotated');
	await dialog.getByRole('button', { name: 'I have kept it' }).click();
	await expect(ada.getByText(next)).toHaveCount(0);
	await expect(ada.locator('[data-key="Dashboard"]')).toContainText('The secret before works until');

	await ada.getByRole('button', { name: 'Revoke Dashboard' }).click();
	await ada.getByRole('dialog').getByRole('button', { name: 'Revoke' }).click();
	await expect(ada.getByRole('status').filter({ hasText: 'The key Dashboard is revoked' })).toBeVisible();
	expect([await read(secret), await read(next)]).toEqual([401, 401]);
});

test('a backup is made and checked by keyboard, damage to one is seen, and the commands that restore it are told', async ({ browse }) => {
	const eva = await browse(EVA, '/backups');
	await expect(eva.getByRole('heading', { name: 'This page needs the role administrator' })).toBeVisible();

	const ada = await browse(ADA, '/backups');
	const standing = ada.locator('[data-standing]');
	await expect(standing).toContainText('There is no backup.');
	await ada.getByRole('button', { name: 'Make a backup now' }).press('Enter');
	const work = ada.getByTestId('backup-work');
	await expect(work).toContainText('The last one was made, and is whole', { timeout: 60_000 });
	await expect(standing).toContainText('The newest backup was made just now');
	const row = ada.locator('[data-backup]');
	await expect(row).toContainText('Ada');
	await expect(row).toContainText('whole, read just now');
	const file = (await row.getAttribute('data-backup')) ?? '';
	const folder = await ada.locator('dd code').first().innerText();
	await expect(ada.getByRole('group', { name: 'To restore the backup' })).toContainText(`restore ${folder}/${file} `);
	await examine(ada, 'backups');

	writeFileSync(join(folder, file), 'damaged');
	await ada.getByRole('button', { name: `Check ${file}` }).press('Enter');
	await expect(work).toContainText('The check has failed', { timeout: 60_000 });
	await expect(standing).toContainText('There is no backup that is whole.');
	await examine(ada, 'backups-damaged');
	rmSync(join(folder, file));
});

test('what is kept is told, and is archived by keyboard', async ({ browse }) => {
	const eva = await browse(EVA, '/storage');
	await expect(eva.getByRole('heading', { name: 'This page needs the role administrator' })).toBeVisible();

	const ada = await browse(ADA, '/storage');
	await expect(ada.locator('[data-standing]')).toContainText('Old records leave the database by themselves');
	const kept = ada.getByRole('region', { name: 'What is kept' });
	await expect(kept).toContainText('30 days in the database, or 10 GB if that is less');
	const folder = await kept.locator('dd code').innerText();
	await expect(ada.getByRole('region', { name: 'Size' })).toContainText('What happened, in the database');
	await examine(ada, 'storage');

	await ada.getByRole('button', { name: 'Archive now' }).press('Enter');
	const work = ada.getByTestId('storage-work');
	await expect(work).toContainText('Last done just now: nothing was old enough', { timeout: 60_000 });
	await expect(ada.getByRole('region', { name: 'Files of the archive' })).toContainText('There are none yet');

	// A folder that cannot be made is told with what to do, and is gone from the page when it can.
	rmSync(folder, { recursive: true, force: true });
	writeFileSync(folder, 'in the way');
	await ada.getByRole('button', { name: 'Archive now' }).press('Enter');
	await expect(ada.locator('[data-standing="trouble"]')).toContainText('Nothing is cut and nothing is lost', { timeout: 60_000 });
	await examine(ada, 'storage-trouble');
	rmSync(folder);
	await ada.getByRole('button', { name: 'Archive now' }).press('Enter');
	await expect(ada.locator('[data-standing="fine"]')).toBeVisible({ timeout: 60_000 });
});

test('sign-in and account are free of barriers, on every screen and in both themes', async ({ browse }) => {
	const door = await browse(null, '/sign-in?to=/users');
	await door.getByRole('button', { name: 'Sign in' }).click();
	await expect(door.getByText('Enter your password.').last()).toBeVisible();
	await examine(door, 'sign-in');

	const ada = await browse(ADA, '/account');
	await expect(ada.getByRole('heading', { name: 'Ada' })).toBeVisible();
	await ada.getByTestId('who').click();
	await examine(ada, 'account');
});
