/** What an engineer writes to build `models/single_bolt`, in the order in which it is built, in the words of the page. */

/** What is written in one field of a form, by the field's label. */
export type Field =
	| { readonly as: 'text' | 'condition' | 'choice' | 'yaml'; readonly label: string; readonly text: string }
	| { readonly as: 'list'; readonly label: string; readonly rows: readonly string[] }
	| { readonly as: 'names'; readonly label: string; readonly rows: readonly (readonly [string, string])[] }
	| { readonly as: 'seconds'; readonly label: string; readonly from: string; readonly to: string }
	| { readonly as: 'part'; readonly label: string; readonly fields: readonly Field[] };

/** What is added by the dialog, and then written in its form. */
export interface Added {
	/** The choice *What* of the dialog. */
	readonly what: string;
	readonly name: string;
	/** The other fields of the dialog, by their labels. */
	readonly asked?: Readonly<Record<string, string>>;
	readonly fields?: readonly Field[];
	/** The whole text of a message definition. */
	readonly text?: string;
	/** What is added to it next, before what comes after it. */
	readonly effects?: readonly Added[];
}

const text = (label: string, text: string): Field => ({ as: 'text', label, text });
const condition = (label: string, text: string): Field => ({ as: 'condition', label, text });
const choice = (label: string, text: string): Field => ({ as: 'choice', label, text });
const yaml = (label: string, text: string): Field => ({ as: 'yaml', label, text });
const list = (label: string, ...rows: string[]): Field => ({ as: 'list', label, rows });
const names = (label: string, ...rows: [string, string][]): Field => ({ as: 'names', label, rows });
const seconds = (label: string, from: string, to = ''): Field => ({ as: 'seconds', label, from, to });
const part = (label: string, ...fields: Field[]): Field => ({ as: 'part', label, fields });

const message = (name: string, ...lines: string[]): Added => ({
	what: 'Message definition: Message definitions',
	name: `bolt_msgs/msg/${name}`,
	text: `${lines.join('\n')}\n`
});
const enumeration = (name: string, values: string): Added => ({
	what: 'Enumeration: Enumerations',
	name,
	asked: { 'Values, with commas between': values }
});
const resource = (name: string, title: string): Added => ({
	what: 'Resource: Resources',
	name,
	fields: [text('Title', title)]
});
const topic = (resource: string, name: string, type: string, direction: 'in' | 'out', ...fields: Field[]): Added => ({
	what: `Topic: Topics of ${resource}`,
	name,
	asked: { 'Message type': `bolt_msgs/msg/${type}`, Direction: direction },
	fields
});
const variable = (section: string, resource: string, name: string, type: string, initial: string): Added => ({
	what: `Variable: ${section} variables of ${resource}`,
	name,
	fields: [text('Type', type), text('First value', initial)]
});
const effect = (resource: string, name: string, kind: string, when: string, does: string[], ...takes: [string, string?]): Added => ({
	what: `Effect: Effects of ${resource}`,
	name,
	fields: [choice('Kind', kind), condition('When', when), list('Actions', ...does), seconds('Takes', ...takes)]
});

const POSES = `home: [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]
above: [0.6, -1.2, 1.4, -1.77, -1.57, 0.6]
at_bolt: [0.6, -0.9, 1.5, -2.17, -1.57, 0.6]`.replaceAll('\n', '\n      ');

/** What the devices say and are told, and the words that are needed to speak about it. */
const WORDS: readonly Added[] = [
	message('NutrunnerState', 'bool tool_is_idle', 'bool tool_is_running_forward', 'bool programmed_torque_reached'),
	message('NutrunnerCommand', 'bool set_tool_idle', 'bool run_tool_forward'),
	message('RobotState', '# Joint angles in rad.', 'float64[6] joint_positions'),
	message('RobotCommand', 'string target_pose', 'float64[6] joint_positions', 'float64 speed_scaling'),
	message('OperatorTask', 'bool place_a_bolt'),
	enumeration('bolt_state', 'empty, placed, tightened'),
	enumeration('named_pose', 'home, above, at_bolt'),
	enumeration('pose', 'unknown, home, above, at_bolt'),
	{
		what: 'Variable: Variables of the station',
		name: 'bolt',
		fields: [text('Type', 'bolt_state'), text('First value', 'empty')]
	}
];

const ROBOT: readonly Added[] = [
	resource('robot', 'Robot'),
	topic('robot', '/robot/state', 'RobotState', 'in', text('Deadline', '1'), yaml('Pipeline', `- discretise:
    field: joint_positions
    variable: pose
    otherwise: unknown
    tolerance: 0.02
    values: &poses
      ${POSES}`)),
	topic('robot', '/robot/command', 'RobotCommand', 'out', text('Every', '1'), yaml('Pipeline', `- undiscretise:
    variable: target_pose
    field: joint_positions
    values: *poses
- constant: {speed_scaling: 0.25}`)),
	variable('Measured', 'robot', 'pose', 'pose', 'home'),
	variable('Output', 'robot', 'target_pose', 'named_pose', 'home'),
	{
		what: 'Ability: Abilities of robot',
		name: 'move_to',
		fields: [
			text('Title', 'Move to {position}'),
			names('Parameters', ['position', 'named_pose']),
			part('Time limits', text('Must have reacted within', '2'), text('Finish', '30')),
			seconds('Duration', '2', '3'),
			condition('Enabled', 'target_pose == pose and pose != position and (pose == above or position == above)'),
			list('Start: Actions', 'target_pose := position'),
			condition('Executing', 'target_pose == position and pose != position'),
			part('Finish', condition('When', 'executing and pose == position'))
		],
		effects: [
			effect('robot', 'robot_leaves', 'starting', 'target_pose != pose and pose != unknown', ['pose := unknown'], '0.1', '0.3'),
			effect('robot', 'robot_arrives', 'executing', 'target_pose != pose and pose == unknown', ['pose := target_pose'], '1.5', '2.5')
		]
	}
];

const NUTRUNNER: readonly Added[] = [
	resource('nutrunner', 'Nutrunner'),
	topic('nutrunner', '/nutrunner/state', 'NutrunnerState', 'in', text('Deadline', '1')),
	topic('nutrunner', '/nutrunner/command', 'NutrunnerCommand', 'out', text('Every', '0.5')),
	variable('Measured', 'nutrunner', 'tool_is_idle', 'bool', 'true'),
	variable('Output', 'nutrunner', 'set_tool_idle', 'bool', 'true'),
	{
		what: 'Ability: Abilities of nutrunner',
		name: 'run_nut',
		fields: [
			text('Title', 'Run the nutrunner'),
			part('Time limits', text('Must have reacted within', '5'), text('Finish', '30')),
			seconds('Duration', '2', '4'),
			condition('Enabled', 'tool_is_idle and set_tool_idle and not tool_is_running_forward and bolt == placed'),
			list('Start: Actions', 'run_tool_forward := true', 'set_tool_idle := false'),
			condition('Executing', 'tool_is_running_forward and not tool_is_idle and not programmed_torque_reached'),
			part(
				'Finish',
				condition('When', 'run_tool_forward and programmed_torque_reached'),
				list('Actions', 'set_tool_idle := true', 'run_tool_forward := false', 'bolt := tightened')
			),
			part('Calling off', list('Actions', 'set_tool_idle := true', 'run_tool_forward := false'))
		],
		effects: [
			effect(
				'nutrunner',
				'tool_starts',
				'starting',
				'run_tool_forward and not set_tool_idle and not tool_is_running_forward',
				['tool_is_running_forward := true', 'tool_is_idle := false'],
				'0.3',
				'0.6'
			),
			effect(
				'nutrunner',
				'torque_is_reached',
				'executing',
				'tool_is_running_forward and not tool_is_idle and not programmed_torque_reached and robot.pose == at_bolt',
				['programmed_torque_reached := true'],
				'1.5',
				'2.5'
			),
			effect(
				'nutrunner',
				'tool_settles',
				'finishing',
				'set_tool_idle and not run_tool_forward and (tool_is_running_forward or programmed_torque_reached or not tool_is_idle)',
				['tool_is_running_forward := false', 'tool_is_idle := true', 'programmed_torque_reached := false'],
				'0.2',
				'0.4'
			)
		]
	}
];

const OPERATOR: readonly Added[] = [
	resource('operator', 'Operator'),
	topic('operator', '/operator/task', 'OperatorTask', 'out', text('Every', '1')),
	variable('Measured', 'operator', 'acknowledged', 'bool', 'false'),
	{
		what: 'Ability: Abilities of operator',
		name: 'place_bolt',
		fields: [
			text('Title', 'Place the bolt'),
			part('Done by a person', text('What the watch says', 'Place a bolt on the cover plate.'), text('Acknowledgement', 'acknowledged')),
			condition('Enabled', 'bolt == empty and not place_a_bolt and not acknowledged'),
			list('Start: Actions', 'place_a_bolt := true'),
			condition('Executing', 'place_a_bolt and not acknowledged'),
			part(
				'Finish',
				condition('When', 'executing and acknowledged'),
				list('Actions', 'place_a_bolt := false', 'bolt := placed')
			)
		],
		effects: [
			effect('operator', 'operator_acknowledges', 'executing', 'place_a_bolt and not acknowledged', ['acknowledged := true'], '4', '8'),
			effect('operator', 'operator_is_free', 'finishing', 'not place_a_bolt and acknowledged', ['acknowledged := false'], '0')
		]
	}
];

/** What must never be, and what is wanted. */
const WANTED: readonly Added[] = [
	{
		what: 'Specification: Specifications',
		name: 'no_standing_tool_on_placed_bolt',
		asked: { 'What it says': 'Never one thing while another holds' },
		fields: [
			text('Title', 'The nutrunner must turn before it meets a placed bolt'),
			condition('Never', 'robot.target_pose == at_bolt or robot.pose == at_bolt'),
			condition('While', 'bolt == placed and not nutrunner.run_nut.executing')
		]
	},
	{
		what: 'Operation: Operations',
		name: 'place_bolt',
		fields: [text('Title', 'Place the bolt'), condition('Precondition', 'bolt == empty'), condition('Goal', 'bolt == placed')]
	},
	{
		what: 'Operation: Operations',
		name: 'tighten_bolt',
		fields: [
			text('Title', 'Tighten the bolt'),
			condition('Precondition', 'bolt == placed'),
			condition('Goal', 'bolt == tightened'),
			text('Priority', '1')
		]
	}
];

/** What the station as a whole is called, and where it rests. */
export const STATION: readonly Field[] = [
	text('Title', 'A single bolt'),
	text('Description', 'An operator places a bolt; a robot guides the nutrunner that tightens it.')
];
export const REST: Field = condition(
	'States of rest',
	'robot.pose == home and robot.target_pose == home and nutrunner.tool_is_idle and nutrunner.set_tool_idle and not operator.place_a_bolt and not operator.acknowledged'
);

export const PARTS = { WORDS, ROBOT, NUTRUNNER, OPERATOR, WANTED } as const;
