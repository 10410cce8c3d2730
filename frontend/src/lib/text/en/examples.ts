/** The example stations, which are looked at and begun with. */
import { count } from '../count.ts';

export const examples = {
	title: 'Example stations',
	open: 'Examples…',
	about: 'Look at how others are built. Nothing can be changed there; parts can be copied, and your own station can begin with one.',
	/** In a draft that holds nothing yet. */
	first: 'Begin with an example',
	firstAbout: 'One press opens it to be looked at. Your draft stays as it is until you begin with one.',
	loading: 'The examples are being read.',
	none: 'There are no example stations',
	noneHow: 'Sequence Planner was installed without them. They are in the folder models of its repository.',
	sizes: (resources: number, abilities: number, operations: number): string =>
		[count(resources, 'resource', 'resources'), count(abilities, 'ability', 'abilities'), count(operations, 'operation', 'operations')].join(', '),
	/** What each shows, by its name. */
	shows: {
		bolt_tightening: 'Shows a person and a robot that take turns, one ability for each of several bolt pairs, and a work master.',
		docking_agv: 'Shows a battery that is never to run out on the way, its dock, and a person who takes kits off.',
		robots_with_buffer: 'Shows two robots of one type, a zone that they share, and an alarm of the station.',
		single_bolt: 'Shows the smallest station that does something. The guide to a first station builds it.',
		truck_engine_station: 'Shows a whole station: tools, an AGV, instructions with pictures, a live picture, shifts, and what to do when the robot is dead.'
	} as Readonly<Record<string, string>>,
	isShown: (title: string): string => `You look at the example station “${title}”. It cannot be changed here.`,
	begin: 'Begin with it',
	back: 'Back to your station',
	begun: (title: string): string => `Begun with “${title}”`,
	replace: {
		title: (title: string): string => `Begin with “${title}”?`,
		about: (files: number): string => `It takes the place of all that is in your draft: ${count(files, 'file', 'files')}.`,
		more: (files: readonly string[], others: number): string => `${files.join(', ')}${others > 0 ? ` and ${others} more` : ''}`,
		stays: 'The name of your station stays, and what runs goes on as it is. You can undo it.'
	}
};
