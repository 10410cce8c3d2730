import { expect, test } from 'vitest';
import { awayOf } from './away.ts';
import type { Told } from './told.ts';

const shown = { x: 100, y: 0, width: 100, height: 100 };

function robot(x: number | null, stops: readonly number[] = [50, 150, 250]): Told {
	const track = { stops: stops.map((x) => ({ x, y: 20 })) };
	return { symbol: { name: 'robot', track }, title: 'Robot', now: { text: 'At the nutrunner' }, stands: x === null ? null : { x, y: 20 } } as unknown as Told;
}

test('who has left what is shown is told with its side, and who is in it or nowhere is not', () => {
	expect(awayOf([robot(50)], shown)).toEqual([{ name: 'robot', title: 'Robot', text: 'At the nutrunner', left: true }]);
	expect(awayOf([robot(250)], shown)[0]?.left).toBe(false);
	expect(awayOf([robot(150)], shown)).toEqual([]);
	expect(awayOf([robot(null)], shown), 'nobody knows where it is').toEqual([]);
	expect(awayOf([robot(300, [250, 300])], shown), 'nothing of its track is shown').toEqual([]);
});
