import { expect, test } from 'vitest';
import { task } from '#lib/testing/view.ts';
import { inOrder } from './oldest.ts';

test('the task that has waited longest comes first; of two created together, the one with the smaller number', () => {
	const tasks = { '2': task(50), '10': task(40), '9': task(40) };
	expect(inOrder(tasks).map(({ id }) => id)).toEqual(['9', '10', '2']);
});
