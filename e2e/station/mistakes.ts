/** What goes wrong while a model is built: each dialog and field says what is wrong, and nothing is lost by it. */
import { expect, test } from '@playwright/test';
import { findings } from './barriers.ts';
import type { Builder } from './building.ts';

type Bad = readonly (readonly [written: string, why: string])[];

const NAMES: Bad = [
	['2nd', 'begins with no digit'],
	['two words', 'letters from A to Z'],
	['and', 'word of the language'],
	['', 'Write a name']
];
const ROBOT = 'resources/robot.yaml';

/** In the dialog that is open: each is refused with why, the button does nothing, and what was written stays. */
async function refuses(builder: Builder, label: string, word: string, bad: Bad): Promise<void> {
	const { dialog, hand } = builder;
	for (const [written, why] of bad) {
		await hand.write(dialog.getByLabel(label, { exact: true }), written);
		await hand.attempt(dialog.getByRole('button', { name: word, exact: true }));
		await expect(dialog.getByRole('alert').filter({ hasText: why })).toBeVisible();
		await expect(dialog.getByLabel(label, { exact: true })).toHaveValue(written);
	}
	expect.soft(await findings(builder.page), `${word} of ${label}`).toEqual([]);
}

async function add(builder: Builder): Promise<void> {
	const { dialog, hand } = builder;
	const what = (words: string): Promise<void> => hand.choose(dialog.getByLabel('What', { exact: true }), words);
	await hand.press(builder.button('Add…'));
	await what('Enumeration: Enumerations');
	await refuses(builder, 'Name', 'Add', [...NAMES, ['pose', 'already']]);
	await hand.write(dialog.getByLabel('Name'), 'colour');
	await refuses(builder, 'Values, with commas between', 'Add', [['', 'at least one value'], ['red, dark green', 'letters, digits and _']]);
	await what('Message definition: Message definitions');
	await refuses(builder, 'Name', 'Add', [['RobotState', 'package, kind and name'], ['bolt_msgs/msg/RobotState', 'already']]);
	await what('Topic: Topics of robot');
	await refuses(builder, 'Name', 'Add', [['/robot state', 'A name of ROS'], ['/robot/state', 'already']]);
	await hand.write(dialog.getByLabel('Name'), '/robot/more');
	await refuses(builder, 'Message type', 'Add', [['RobotState', 'package, kind and name']]);
	await hand.press(dialog.getByRole('button', { name: 'Cancel' }));
	await expect(builder.button('Add…')).toBeFocused();
}

/** The ability gets another name, the old one again, and the other one again; the old one is what it stays with. */
async function rename(builder: Builder): Promise<void> {
	const { dialog, form, hand, page } = builder;
	const heading = form.getByRole('heading').first();
	await builder.choose('move_to', ROBOT, 'abilities', 'move_to');
	await hand.press(builder.button('Rename…'));
	await refuses(builder, 'New name', 'Rename', NAMES);
	await hand.write(dialog.getByLabel('New name'), 'go_to');
	await hand.press(dialog.getByRole('button', { name: 'Rename', exact: true }));
	await expect(heading).toContainText('go_to');
	const again = (word: string): Promise<void> => hand.press(page.getByRole('button', { name: new RegExp(`^${word}:`) }));
	const name = (is: string): Promise<void> =>
		expect(builder.file).toContainText(new RegExp(`abilities:\\s*${is}:`));
	await again('Undo');
	await name('move_to');
	// What was chosen is there no more: then what it was in is.
	await expect(heading).toContainText('Abilities');
	await again('Redo');
	await name('go_to');
	await again('Undo');
	await name('move_to');
	await expect(heading).toContainText('Abilities');
}

async function duplicateAndDelete(builder: Builder): Promise<void> {
	const { dialog, form, hand } = builder;
	await builder.choose('robot_leaves', ROBOT, 'abilities', 'move_to', 'effects', 'robot_leaves');
	await hand.press(builder.button('Duplicate…'));
	await refuses(builder, 'Name of the copy', 'Duplicate', [...NAMES, ['robot_arrives', 'already']]);
	await hand.write(dialog.getByLabel('Name of the copy'), 'spare');
	await hand.press(dialog.getByRole('button', { name: 'Duplicate', exact: true }));
	await expect(form.getByRole('heading').first()).toContainText('spare');
	await hand.press(builder.button('Delete…'));
	await expect(dialog).toContainText('Nothing else names it.');
	await hand.press(dialog.getByRole('button', { name: 'Delete', exact: true }));
	await expect(dialog).toBeHidden();
	await expect(builder.file).not.toContainText('spare');

	await builder.choose('target_pose', ROBOT, 'output', 'target_pose');
	await hand.press(builder.button('Delete…'));
	await expect(dialog).toContainText('will be wrong without it');
	expect.soft(await findings(builder.page), 'Delete').toEqual([]);
	await hand.press(dialog.getByRole('button', { name: 'Cancel' }));
	await expect(builder.file).toContainText(/output:\s*target_pose:/);
}

/** What is written in fields: a number, YAML that cannot be read, and a name that is put right by completion. */
async function fields(builder: Builder): Promise<void> {
	const { form, hand, page } = builder;
	await builder.choose('/robot/state', ROBOT, 'topics', '/robot/state');
	const deadline = builder.textbox('Deadline');
	await hand.write(deadline, 'soon');
	await hand.leave();
	await expect(form).toContainText('Write a number, such as 2.5.');
	await expect(deadline).toHaveValue('soon');
	await hand.write(deadline, '1');
	await hand.leave();
	await builder.written();

	await builder.choose('move_to', ROBOT, 'abilities', 'move_to');
	const executing = builder.editor('Executing');
	await builder.reveal(executing);
	const before = await executing.innerText();
	await hand.write(executing, 'target_pos == position and pose != position');
	await expect(form.locator('[data-path="executing"]')).toContainText('did you mean `target_pose`?');
	await hand.write(executing, '');
	await page.keyboard.type('targ');
	await expect(page.locator('.cm-tooltip-autocomplete')).toContainText('target_pose');
	// What has only just been offered is not taken by a key that was meant for something else.
	await expect(async () => {
		await page.keyboard.press('Enter');
		await expect(executing).toHaveText('target_pose', { timeout: 500 });
	}).toPass();
	await page.keyboard.type(' == position and pose != position');
	await hand.leave();
	await expect(executing).toHaveText(before);
	await builder.written();
}

/** All of it, in a model that has the robot. */
export async function mistakes(builder: Builder): Promise<void> {
	await test.step('what cannot be added', () => add(builder));
	await test.step('what cannot be a name; undone and done again', () => rename(builder));
	await test.step('a copy that was not needed; what is needed stays', () => duplicateAndDelete(builder));
	await test.step('what cannot stand in a field', () => fields(builder));
}
