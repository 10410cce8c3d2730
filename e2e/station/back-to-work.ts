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
		// While ways are looked for, the step that is next opens by itself as soon as it is known.
		if (next === 'looking') return false;
		// Whoever has looked at another step comes back to the one that is next.
		const shut = this.restart.locator('[data-restart-step][aria-current="step"][aria-expanded="false"]');
		if ((await shut.count()) > 0) await shut.click({ timeout: PRESS }).catch(() => undefined);
		switch (next) {
			case 'enter':
				return this.#pressActs('enter');
			case 'answer':
				return (await this.#pressActs('control')) || this.#answer();
			case 'decide':
				return (await this.#pressActs('control')) || this.#decide();
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
			case 'start':
			case 'continue':
				return this.#pressActs(next === 'start' ? 'start' : 'go');
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

	/** The one button that has such an act among those that it does; false where there is none, or it cannot be pressed now. */
	async #pressActs(act: string): Promise<boolean> {
		const button = this.restart.locator(`main button.wanted[data-acts~="${act}"]`);
		if ((await button.count()) === 0) return false;
		await button.first().click({ timeout: PRESS }).catch(() => undefined);
		return true;
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
			return corrects ? this.#correct() : true;
		}
		await this.restart.getByRole('button', { name: 'Confirm all of it' }).click();
		return this.#send('Confirm');
	}

	/** Once it was seen what follows, with a reason; once more where it breaks what was specified. */
	async #correct(): Promise<boolean> {
		await expect(this.#dialog.getByTestId('follows')).toBeVisible();
		await this.#dialog.getByLabel('Reason').fill(REASON);
		await this.#dialog.getByRole('button', { name: `Correct to ${this.hands.truth ?? ''}`, exact: true }).click();
		const sure = this.#dialog.getByRole('button', { name: 'Yes, correct it' });
		await expect(this.#dialog.filter({ hasNot: sure })).toHaveCount(0);
		if (await sure.isVisible()) await sure.click();
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
		const offers = this.restart.locator('main [data-offer]');
		if ((await offers.count()) === 0) return false;
		const plain = offers.filter({ hasNotText: /\d+ corrections?:/ });
		const corrects = (await plain.count()) === 0;
		if (corrects && !this.#mended) {
			this.#mended = true;
			await this.hands.mend();
			return false;
		}
		const chosen = (corrects ? offers : plain).first();
		await chosen.getByRole('radio').check({ timeout: PRESS }).catch(() => undefined);
		const plan = this.restart.getByTestId('way-plan');
		const take = plan.getByTestId('take').locator('[data-acts]');
		const fresh = plan.getByRole('button', { name: 'Check again' });
		const gone = async (): Promise<boolean> => (await this.restart.locator('main [data-offer]').count()) === 0;
		try {
			for (const box of await plan.getByRole('checkbox').all()) await box.check({ timeout: PRESS });
			if (!(await fresh.isVisible())) await take.click({ timeout: PRESS });
		} catch {
			return false; // what was offered is another by now
		}
		// It may move in the very moment in which it is pressed.
		await expect.poll(async () => (await gone()) || (await fresh.isVisible()), { timeout: 4 * PRESS }).toBe(true);
		if (await gone()) return true;
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
