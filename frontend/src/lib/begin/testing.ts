/** Outlines for tests. */
import type { Outline } from '#lib/contract.ts';

/** An operator places a bolt, a robot guides the tool that tightens it. */
export const BOLT: Outline = {
	title: 'Bolt',
	devices: [
		{ kind: 'person', name: 'operator', title: 'Operator' },
		{
			kind: 'robot',
			name: 'robot',
			title: 'Robot',
			ways: 'row',
			poses: [
				{ name: 'home', title: 'home', joints: [0, -1.57] },
				{ name: 'above', title: 'above the bolt', joints: [0.6, -1.2] },
				{ name: 'at_bolt', title: 'at the bolt', joints: [0.6, -0.9] }
			]
		},
		{ kind: 'tool', name: 'nutrunner', title: 'Nutrunner' },
		{ kind: 'found', name: 'lamp', title: 'Lamp', topics: ['/lamp/state'] }
	],
	product: {
		name: 'bolt',
		title: 'bolt',
		then: 'next',
		states: [
			{ name: 'missing', title: 'missing' },
			{ name: 'placed', title: 'placed' },
			{ name: 'tight', title: 'tight' }
		],
		steps: [
			{ name: 'place_it', title: 'Place the bolt', by: 'operator', action: null, where: [] },
			{ name: 'tighten', title: 'Tighten the bolt', by: 'nutrunner', action: null, where: [{ robot: 'robot', pose: 'at_bolt' }] }
		]
	},
	never: [
		{
			title: '',
			facts: [{ thing: 'robot', value: 'at_bolt', holds: true }],
			during: [{ thing: 'step:operator.place_it', value: 'under_way', holds: false }]
		}
	]
};

/** Two robots that hand something over behind a door. */
export const DOOR: Outline = {
	title: 'Door',
	devices: [
		{ kind: 'robot', name: 'left', title: 'Left robot', ways: 'any', poses: [{ name: 'home', title: 'home', joints: [] }, { name: 'table', title: 'at the table', joints: [] }] },
		{ kind: 'robot', name: 'right', title: 'Right robot', ways: 'any', poses: [{ name: 'home', title: 'home', joints: [] }, { name: 'table', title: 'At the table', joints: [] }] },
		{ kind: 'clamp', name: 'gripper', title: 'Gripper' },
		{ kind: 'clamp', name: 'door', title: 'Door' },
		{ kind: 'tool', name: 'press', title: 'Press' }
	],
	product: {
		name: 'part',
		title: '',
		then: 'order',
		states: [
			{ name: 'raw', title: '' },
			{ name: 'held', title: '' },
			{ name: 'pressed', title: '' }
		],
		steps: [
			{ name: 'grip', title: 'Grip it', by: 'gripper', action: 'close', where: [{ robot: 'left', pose: 'table' }] },
			{ name: 'press_it', title: 'Press it', by: 'press', action: null, where: [] }
		]
	},
	never: [
		{
			title: 'They do not meet',
			facts: [
				{ thing: 'left', value: 'table', holds: true },
				{ thing: 'right', value: 'table', holds: true }
			],
			during: []
		}
	]
};
