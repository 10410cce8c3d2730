/** What abilities, and the parts of one, are called. */
import { plain } from '#lib/wording/values.ts';

/** `robot.move_to_position(home).robot_arrives` → `robot arrives`. */
export function reactionName(name: string): string {
	return plain(name.slice(name.lastIndexOf('.') + 1));
}

/** Whether an ability of the station is that of the model, or one of those that it stands for. */
export function isOf(name: string, ability: string): boolean {
	return name === ability || name.startsWith(`${ability}(`);
}

/** The ability of the model that one of the station is, or that stands for it. */
export function wholeName(name: string): string {
	return name.replace(/\(.*$/s, '');
}
