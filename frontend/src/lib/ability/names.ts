/** What the parts of an ability are called. */
import { plain } from '#lib/wording/values.ts';

/** `robot.move_to_position(home).robot_arrives` → `robot arrives`. */
export function reactionName(name: string): string {
	return plain(name.slice(name.lastIndexOf('.') + 1));
}
