import { expect, test } from 'vitest';
import type { DraftPipelines } from '#lib/contract.ts';
import { joinedBy, joinOf } from './joining.ts';
import type { Box } from './picture.ts';

const box = (kind: Box['kind'], pipeline: string, name: string): Box => ({ id: name, kind, pipeline, stage: null, name, about: '', troubles: [], type: null, rows: [], more: 0, spot: null });
const view = {
	pipelines: {
		'/state': { id: '/state', role: 'incoming', edges: [{}, {}], ends: [{ field: 'at', becomes: 'robot.pose' }], sources: [], first: [] },
		'/other': { id: '/other', role: 'incoming', edges: [{}], ends: [], sources: [], first: [] },
		'robot.both': { id: 'robot.both', role: 'flow', edges: [{}], ends: [], sources: [{ pipeline: '/state' }], first: [] },
		'/command': {
			id: '/command', role: 'outgoing', edges: [{ fields: { target: 'pose', stop: 'bool' } }], ends: [], sources: [],
			first: [{ field: 'target', variable: 'robot.target', sent: true }, { field: 'stop', variable: 'robot.stop', sent: false }]
		}
	}
} as unknown as Pick<DraftPipelines, 'pipelines'>;
const [state, flow, command] = [box('topic', '/state', '/state'), box('flow', 'robot.both', 'both'), box('topic', '/command', '/command')];

test('what is connected already is told, with the field by which it is', () => {
	expect(joinedBy(state, box('variable', '/state', 'robot.pose'), view)).toEqual({ pipeline: '/state', field: 'at' });
	expect(joinedBy(box('stage', '/state', 'limit'), box('variable', '/state', 'robot.pose'), view)).toEqual({ pipeline: '/state', field: 'at' });
	expect(joinedBy(state, flow, view)).toEqual({ pipeline: 'robot.both', field: null });
	expect(joinedBy(box('variable', '/command', 'robot.target'), command, view)).toEqual({ pipeline: '/command', field: 'target' });
});

test('what is not is joined as it is meant', () => {
	for (const [from, to] of [[state, box('variable', '/state', 'robot.moving')], [box('topic', '/other', '/other'), flow], [box('variable', '/command', 'robot.stop'), command]] as const) {
		expect(joinedBy(from, to, view)).toBeNull();
		expect(joinOf(from, to, view)).not.toBeNull();
	}
	expect(joinedBy(state, command, view)).toBeNull();
	expect(joinOf(state, command, view)).toBeNull();
});
