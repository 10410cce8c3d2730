/**
 * Somebody who gets a station back to work by the page Restart alone: what it says comes next is what they do.
 *
 * What happens beside the page (devices that are brought back, what is really in the holes) is up to `Hands`.
 */
import { expect, type Page } from '@playwright/test';
import { acknowledge, done } from './seen.ts';

export interface Hands {
	/** Does at the devices what the page asks of a person. */
	readonly mend: () => Promise<void>;
	/** What is true, in the words of the page: `empty`. */
	readonly truth?: string;
}

const REASON = 'as the page says';
/** Milliseconds within which a press has its effect, unless the station has moved since. */
const PRESS = 5000;
const PATIENCE = 30_000;

export class Back {
	/** What was done, in its order. */
	readonly acts: string[] = [];
	#mended = false;

	constructor(
		readonly restart: Page,
		readonly hands: Hands,
		/** Milliseconds without anything to do but wait, after which it is stuck. */
		readonly patience = PATIENCE
	) {}

	/** Until nothing is left to do; an error when it does not come to that. */
	async toWork(): Promise<void> {
		let since = Date.now();
		while (Date.now() - since < this.patience) {
			const next = (await this.restart.getByTestId('next-act').getAttribute('data-next')) ?? '';
			if (next === 'nothing') return;
			if (await this.#do(next)) {
				this.acts.push(next);
				since = Date.now();
				// What it did shows in the stream.
				await expect
					.poll(() => this.restart.getByTestId('next-act').getAttribute('data-next'), { timeout: 8000 })
					.not.toBe(next)
					.catch(() => undefined);
			} else await this.restart.waitForTimeout(100);
		}
		throw new Error(`stuck after ${this.acts.join(', ')}: ${await this.restart.locator('main').innerText()}`);
	}

	/** Does what comes next; false where there is nothing to do but wait. */
	async #do(next: string): Promise<boolean> {
		switch (next) {
			case 'control':
				await this.restart.getByRole('button', { name: 'Take control' }).click();
				return true;
			case 'enter':
				return this.#withReason('Enter restart mode');
			case 'answer':
				return this.#answer();
			case 'decide':
				return this.#decide();
			case 'look':
			case 'physical':
				if (this.#mended) return false;
				this.#mended = true;
				await this.hands.mend();
				// What is brought back is noticed by itself; of what is moved by hand a person says so.
				if ((await this.restart.locator('[data-physical]').count()) > 0)
					await this.restart.getByRole('button', { name: 'Done, check again' }).first().click();
				return true;
			case 'take':
			case 'check':
				return this.#take();
			case 'leave':
				return this.#press('Leave restart mode');
			case 'start':
				return this.#press('Start production');
			case 'continue':
				return this.#press('Continue');
			default:
				return false;
		}
	}

	get #dialog() {
		return this.restart.getByRole('dialog');
	}

	async #isClosed(): Promise<boolean> {
		return (await this.#dialog.count()) === 0;
	}

	/** An act of the page itself, not the one of the header by the same name. */
	async #press(name: string): Promise<boolean> {
		await this.restart.locator('main').getByRole('button', { name, exact: true }).click();
		return true;
	}

	async #withReason(name: string): Promise<boolean> {
		await this.#press(name);
		return this.#send(name);
	}

	/** Where the station has moved meanwhile, what there is to see is looked at again first. */
	async #send(name: string): Promise<boolean> {
		const again = this.#dialog.getByRole('button', { name: 'Look again' });
		await this.#dialog.getByLabel('Reason').fill(REASON);
		await expect(async () => {
			if (await this.#isClosed()) return;
			if (await again.isVisible()) await again.click({ timeout: PRESS });
			await this.#dialog.getByRole('button', { name, exact: true }).click({ timeout: PRESS });
			await expect(this.#dialog).toHaveCount(0, { timeout: PRESS });
		}).toPass({ timeout: 4 * PRESS });
		return true;
	}

	async #answer(): Promise<boolean> {
		const question = this.restart.getByTestId('question');
		if ((await question.count()) > 0) {
			const { truth = '' } = this.hands;
			const corrected = question.getByRole('button', { name: `It is ${truth}`, exact: true });
			const corrects = (await corrected.count()) > 0;
			await (corrects ? corrected : question.getByRole('button', { name: /^Yes, / })).click();
			return corrects ? this.#correct() : this.#send('Confirm');
		}
		await this.restart.getByRole('button', { name: 'All of it is so' }).click();
		return this.#send('Confirm');
	}

	/** Once it was seen what follows, with a reason and once more. */
	async #correct(): Promise<boolean> {
		await expect(this.#dialog.getByTestId('follows')).toBeVisible();
		await this.#dialog.getByLabel('Reason').fill(REASON);
		await this.#dialog.getByRole('button', { name: 'Correct…', exact: true }).click();
		await this.#dialog.getByRole('button', { name: 'Yes, correct it' }).click();
		await expect(this.#dialog).toHaveCount(0);
		return true;
	}

	async #decide(): Promise<boolean> {
		await this.restart.getByRole('button', { name: 'Decide', exact: true }).click();
		for (const group of await this.#dialog.getByRole('group').all()) await group.getByRole('radio').first().check();
		return this.#send('Decide');
	}

	/**
	 * The first way that does not say what nobody has looked at; every start and every correction is confirmed. Whoever is
	 * offered nothing but corrections looks first, and sees to what the alarms say. Where the station has moved meanwhile
	 * nothing is taken.
	 */
	async #take(): Promise<boolean> {
		const offers = this.restart.locator('[data-offer]').filter({ has: this.restart.getByRole('button', { name: /^Take…/ }) });
		if ((await offers.count()) === 0) return false;
		const plain = offers.filter({ hasNotText: 'Only if it is so' });
		const corrects = (await plain.count()) === 0;
		if (corrects && !this.#mended) {
			this.#mended = true;
			await this.hands.mend();
			return false;
		}
		const chosen = (corrects ? offers : plain).first();
		await chosen.getByRole('button', { name: /^Take…/ }).click();
		for (const box of await this.#dialog.getByRole('checkbox').all()) await box.check();
		await this.#dialog.getByLabel('Reason').fill(REASON);
		const fresh = this.#dialog.getByRole('button', { name: 'Back to fresh offers' });
		const take = this.#dialog.getByRole('button', { name: 'Take it' });
		// It may move in the very moment in which it is pressed.
		if (!(await fresh.isVisible())) await take.click({ timeout: PRESS }).catch(() => undefined);
		await expect.poll(async () => (await this.#isClosed()) || (await fresh.isVisible()), { timeout: 4 * PRESS }).toBe(true);
		if (await this.#isClosed()) return true;
		await fresh.click();
		return false;
	}
}

/** Serves the watch until `what` holds. */
export async function served(watch: Page, what: () => Promise<boolean>, seconds: number): Promise<void> {
	const end = Date.now() + seconds * 1000;
	while (!(await what())) {
		if (Date.now() > end) throw new Error(`not within ${seconds} s`);
		const ready = done(watch).and(watch.locator('[aria-disabled="false"]'));
		if ((await ready.count()) > 0) await acknowledge(watch).catch(() => undefined);
		else await watch.waitForTimeout(50);
	}
}
