/** What probably must never be, of what was said of the station. */
import type { DeviceSketch, FactSketch, NeverSketch, Sketch } from './sketch.ts';
import { titled } from './things.ts';

/** More would not be read. */
const MOST = 3;

export interface Suggested {
	readonly facts: readonly Pick<FactSketch, 'thing' | 'value' | 'holds'>[];
	readonly during: readonly Pick<FactSketch, 'thing' | 'value' | 'holds'>[];
}

const is = (thing: number, value: number | string): Suggested['facts'][number] => ({ thing, value, holds: true });

/** Up to three, the likeliest first, without those that are there. */
export function suggestionsOf(sketch: Sketch): Suggested[] {
	return [...nearPeople(sketch), ...nearDoors(sketch), ...together(sketch), ...unheld(sketch)]
		.filter((each) => !sketch.never.some((never) => isOf(each, never)))
		.slice(0, MOST);
}

/** Whether somebody has said the like: the same facts, in any order, while something of the same things holds. */
function isOf({ facts, during }: Suggested, never: NeverSketch): boolean {
	const told = (of: Suggested['facts']): string => of.map(({ thing, value, holds }) => `${thing} ${value} ${holds}`).sort().join();
	return told(facts) === told(never.facts) && during.every(({ thing }) => never.during.some((each) => each.thing === thing));
}

/** Where a robot is while something is done to the product: the poses that a person or a door may be in the way of. */
function atWork(robot: DeviceSketch, sketch: Sketch, except: number): number[] {
	const at = (among: Sketch['product']['steps']): Set<number> =>
		new Set(among.flatMap(({ where }) => where.flatMap((each) => (each.robot === robot.id && each.pose !== null ? [each.pose] : []))));
	// What the other does itself while the robot is there is meant to be.
	const [theirs, meant] = [at(sketch.product.steps.filter(({ by }) => by !== except)), at(sketch.product.steps.filter(({ by }) => by === except))];
	return robot.poses.map(({ id }) => id).filter((id) => theirs.has(id) && !meant.has(id));
}

function nearPeople(sketch: Sketch): Suggested[] {
	const people = sketch.devices.filter(({ kind }) => kind === 'person');
	return people.flatMap((person) =>
		robots(sketch).flatMap((robot) =>
			atWork(robot, sketch, person.id).map((pose) => ({ facts: [is(robot.id, pose)], during: [is(person.id, 'busy')] }))
		)
	);
}

/** One that opens and closes and has no part in the work is a door, as far as anybody can tell. */
function nearDoors(sketch: Sketch): Suggested[] {
	const doors = sketch.devices.filter(({ id, kind }) => kind === 'clamp' && !sketch.product.steps.some(({ by }) => by === id));
	return doors.flatMap((door) =>
		robots(sketch).flatMap((robot) => atWork(robot, sketch, door.id).map((pose) => ({ facts: [is(robot.id, pose)], during: [is(door.id, 'open')] })))
	);
}

/** Two robots in poses that are called alike. */
function together(sketch: Sketch): Suggested[] {
	const all = robots(sketch);
	return all.flatMap((one, at) =>
		all.slice(at + 1).flatMap((other) =>
			one.poses.flatMap((pose, rank) => {
				const same = other.poses.find((each, place) => (rank > 0 || place > 0) && titled(each).toLowerCase() === titled(pose).toLowerCase());
				return same && titled(pose) !== '' ? [{ facts: [is(one.id, pose.id), is(other.id, same.id)], during: [] }] : [];
			})
		)
	);
}

/** A tool at a product that a clamp holds by then. */
function unheld(sketch: Sketch): Suggested[] {
	const { steps } = sketch.product;
	const kindOf = (id: number | null): string | undefined => sketch.devices.find((each) => each.id === id)?.kind;
	return steps.flatMap((step, at) => {
		if (kindOf(step.by) !== 'tool' || step.by === null) return [];
		const tool = step.by;
		const holds = steps.slice(0, at).findLast(({ by }) => kindOf(by) === 'clamp');
		if (holds?.action !== 'close' || holds.by === null) return [];
		return [{ facts: [is(tool, 'running')], during: [is(holds.by, 'open')] }];
	});
}

function robots({ devices }: Sketch): DeviceSketch[] {
	return devices.filter(({ kind }) => kind === 'robot');
}
