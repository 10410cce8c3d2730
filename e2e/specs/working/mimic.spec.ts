import type { Locator, Page } from '@playwright/test';
import { findings, overflow } from '../../station/barriers.ts';
import { acknowledge, restsOnPerson } from '../../station/seen.ts';
import { expect, test } from '../../station/test.ts';

const picture = (page: Page): Locator => page.getByTestId('mimic');
const token = (page: Page): Locator => picture(page).locator('[data-token="robot"]');

/** Whether the robot stands where its stop is, or has gone on from there; looked at in one moment, as it may set off in the next. */
const arrived = (page: Page, stop: string): Promise<boolean> =>
	picture(page).evaluate((drawn, at) => {
		const robot = drawn.querySelector('[data-token="robot"]');
		if (robot?.getAttribute('data-at') !== at) return true;
		if (robot.getAnimations().length > 0) return false;
		const [one, other] = [robot.querySelector('.disc'), drawn.querySelector(`[data-stop="${at}"]`)].map((each) => each?.getBoundingClientRect());
		if (!one || !other) return false;
		return Math.abs(one.x + one.width / 2 - other.x - other.width / 2) + Math.abs(one.y + one.height / 2 - other.y - other.height / 2) <= 4;
	}, stop);

type Looks = Record<string, string[]>;

/** Notes from now on how the bolts look while the robot is there: a look comes and goes faster than a busy machine asks for it. */
const watchLooks = (page: Page): Promise<void> =>
	picture(page).evaluate((drawn) => {
		const looks: Looks = {};
		Object.assign(window, { looks });
		const note = (): void => {
			const at = drawn.querySelector('[data-token="robot"]')?.getAttribute('data-at') ?? '';
			const look = drawn.querySelector(`[data-part="bolts[${at}]"]`)?.getAttribute('data-look');
			if (look) (looks[at] ??= []).push(look);
		};
		new MutationObserver(note).observe(drawn, { subtree: true, attributeFilter: ['data-at', 'data-look'] });
	});

const looksAt = (page: Page, stop: string): Promise<string[]> =>
	page.evaluate((at) => (window as unknown as { looks: Looks }).looks[at] ?? [], stop);

test('the robot of the picture goes where the robot goes, and the bolts look as they are', async ({ operate, watch, complaints }) => {
	await restsOnPerson(operate, watch);
	await expect(picture(operate)).toHaveAttribute('data-made-from', 'file');
	await watchLooks(operate);
	const pair = await acknowledge(watch);
	await expect.poll(() => looksAt(operate, pair), { timeout: 60_000 }).toEqual(expect.arrayContaining([expect.stringMatching(/placed|done/)]));
	// It does not jump: it goes there, and then is where its stop is.
	await expect.poll(() => arrived(operate, pair)).toBe(true);
	await restsOnPerson(operate, watch);
	expect(complaints).toEqual([]);
});

test('who wants no motion sees none', async ({ operate, watch }) => {
	await operate.emulateMedia({ reducedMotion: 'reduce' });
	await restsOnPerson(operate, watch);
	await operate.evaluate(() => {
		const seen = { moves: 0 };
		Object.assign(window, { seen });
		const animate = Element.prototype.animate;
		Element.prototype.animate = function (...given) {
			seen.moves += 1;
			return animate.apply(this, given);
		};
	});
	const pair = await acknowledge(watch);
	await expect(token(operate)).toHaveAttribute('data-at', pair);
	expect(await operate.evaluate(() => (window as unknown as { seen: { moves: number } }).seen.moves)).toBe(0);
	await restsOnPerson(operate, watch);
});

test('the picture is one stop of the Tab key, and shows a thing with Enter @theme', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	const things = picture(operate).locator('[role="button"]');
	await expect(things.first()).toBeVisible();
	expect(await things.evaluateAll((all) => all.filter((each) => each.getAttribute('tabindex') === '0').length)).toBe(1);
	await picture(operate).locator('[data-symbol="nutrunner"]').focus();
	await operate.keyboard.press('ArrowDown');
	await expect(picture(operate).locator('[data-symbol="planning_scene"]')).toBeFocused();
	await operate.keyboard.press('ArrowRight');
	await operate.keyboard.press('ArrowUp');
	await picture(operate).locator('[data-symbol="robot"]').focus();
	await operate.keyboard.press('Enter');
	const dialog = operate.getByRole('dialog', { name: 'Robot UR10' });
	await expect(dialog.getByRole('link', { name: 'Move to home' })).toBeVisible();
	await expect(dialog).toContainText('Target of the robot');
	expect(await findings(operate)).toEqual([]);
	await operate.keyboard.press('Escape');
	await expect(dialog).toBeHidden();
	await expect(picture(operate).locator('[data-symbol="robot"]')).toBeFocused();

	await operate.getByRole('button', { name: 'in words' }).click();
	const words = operate.getByRole('table', { name: /^Live picture of/ });
	await expect(words.getByRole('row', { name: /^Cover plate/ })).toContainText('Bolt pair 1: ');
	expect(await findings(operate)).toEqual([]);
	await operate.getByRole('button', { name: 'in words' }).click();
});

test('on a small screen what has no room in the picture stands in rows', async ({ operate, watch }) => {
	await restsOnPerson(operate, watch);
	for (const width of [390, 320]) {
		await operate.setViewportSize({ width, height: 800 });
		const row = picture(operate).locator('button[data-symbol="nutrunner"]');
		await expect(row).toContainText('Nutrunner');
		await expect(picture(operate).locator('[role="button"][data-symbol="cover_plate"]')).toBeVisible();
		expect(await overflow(operate)).toBe(0);
		expect(await findings(operate)).toEqual([]);
	}
});

test.describe('a device that is silent', () => {
	test.use({ shared: null });

	test('lights up, and nobody pretends to know where it is', async ({ operate, station }) => {
		await expect(token(operate)).not.toHaveAttribute('data-at', '', { timeout: 60_000 });
		await station.fault('robot silent');
		await expect(picture(operate).locator('[data-symbol="robot"]')).toHaveAttribute('data-alarm', /high|medium/);
		// The mark of the alarm is at the corner of the robot, and as small as in a list.
		const [robot, mark] = [await picture(operate).locator('[data-symbol="robot"]').boundingBox(), await picture(operate).locator('.mark').boundingBox()];
		expect(mark?.width).toBeLessThan(48);
		expect(Math.abs((mark?.x ?? 0) - (robot ? robot.x + robot.width : 0))).toBeLessThan(48);
		await expect(token(operate)).toHaveAttribute('data-at', '');
		await expect(picture(operate).locator('[data-symbol="robot"]')).toHaveAccessibleName(/Not heard/);
		await station.fault('clear');
		await expect(token(operate)).not.toHaveAttribute('data-at', '');
	});
});
