import { expect, test } from 'vitest';
import { temporaryPassword } from './temporary.ts';

test('a temporary password has four groups of four letters, none of which is taken for another', () => {
	for (let n = 0; n < 200; n++)
		expect(temporaryPassword()).toMatch(/^([a-hjkmnp-z2-9]{4}-){3}[a-hjkmnp-z2-9]{4}$/);
});

test('bytes that would make some letters likelier are passed over', () => {
	let calls = 0;
	const word = temporaryPassword((bytes) => bytes.fill(calls++ === 0 ? 255 : 1));
	expect(word).toBe('bbbb-bbbb-bbbb-bbbb');
});
