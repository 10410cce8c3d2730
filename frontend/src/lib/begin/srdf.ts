/** Named poses of an SRDF: `<group_state name group>` with a `<joint name value>` for each joint, as MoveIt has them. */
import { numbersText } from './numbers.ts';
import { readXml, type XmlElement } from './xml.ts';

export interface GroupState {
	readonly name: string;
	/** Its joints in the order of the group's first state; empty where `wrong`. */
	readonly joints: readonly number[];
	/** Why it cannot be a pose; null where it can. */
	readonly wrong: Lacking | null;
}

/** No name; a joint without a name or a number; one that the first state has, or has not. */
export type Lacking = { readonly what: 'name' } | { readonly what: 'number' | 'missing' | 'other'; readonly joint: string };

export interface Group {
	readonly name: string;
	readonly joints: readonly string[];
	readonly states: readonly GroupState[];
}

/** Why nothing can be read: it is no XML, has entities of its own, or no group states. */
export type Unread = { readonly what: 'xml'; readonly line: number } | { readonly what: 'entities' | 'none' | 'long' };

/** Letters: a robot with some thousands of states has fewer. */
const LONGEST = 5_000_000;

/** The groups of an SRDF, each with its states. */
export function readSrdf(text: string): readonly Group[] | Unread {
	if (text.length > LONGEST) return { what: 'long' };
	// They could stand for other files, or for texts without end; an SRDF has none.
	if (/<!(?:DOCTYPE|ENTITY)/i.test(text)) return { what: 'entities' };
	const root = readXml(text);
	if ('line' in root) return { what: 'xml', line: root.line };
	const groups = groupsIn(root);
	return groups.length === 0 ? { what: 'none' } : groups;
}

/** The group states anywhere in an element, by group. */
function groupsIn(root: XmlElement): Group[] {
	const found = new Map<string, XmlElement[]>();
	const waiting: XmlElement[] = [root];
	for (let element = waiting.pop(); element !== undefined; element = waiting.pop()) {
		if (element.name === 'group_state') {
			const group = element.attributes.get('group') ?? '';
			const states = found.get(group);
			if (states) states.push(element);
			else found.set(group, [element]);
		} else for (const child of element.children.toReversed()) waiting.push(child);
	}
	return [...found].map(([name, states]) => groupOf(name, states));
}

function groupOf(name: string, elements: readonly XmlElement[]): Group {
	const all = elements.map((element) => ({ name: element.attributes.get('name')?.trim() ?? '', joints: jointsOf(element) }));
	const joints = [...(all[0]?.joints.keys() ?? [])];
	const states = all.map(({ name: state, joints: given }): GroupState => {
		const wrong = lacking(state, given, joints);
		return { name: state, joints: wrong === null ? joints.flatMap((joint) => given.get(joint) ?? []) : [], wrong };
	});
	return { name, joints, states };
}

function jointsOf({ children }: XmlElement): Map<string, number[] | null> {
	const joints = children.filter(({ name }) => name === 'joint').map(({ attributes }) => attributes);
	return new Map(joints.map((joint) => [joint.get('name')?.trim() ?? '', numbersIn(joint.get('value') ?? '')]));
}

/** A joint that turns in several ways has several numbers. */
function numbersIn(value: string): number[] | null {
	const numbers = value.split(/\s+/).filter(Boolean).map(Number);
	return numbers.length > 0 && numbers.every(Number.isFinite) ? numbers : null;
}

function lacking(state: string, given: ReadonlyMap<string, number[] | null>, joints: readonly string[]): Lacking | null {
	if (state === '') return { what: 'name' };
	for (const [joint, numbers] of given) {
		if (numbers === null || joint === '') return { what: 'number', joint };
		if (!joints.includes(joint)) return { what: 'other', joint };
	}
	const joint = joints.find((each) => !given.has(each));
	return joint === undefined ? null : { what: 'missing', joint };
}

/** A state as its pose is written. */
export function jointsText({ joints }: GroupState): string {
	return numbersText(joints);
}
