import { expect, test } from 'vitest';
import { stateText } from './standing.ts';

test('what is most in the way is said of the station: that it stands, then what is not heard, then what needs help', () => {
	expect(stateText('working', [], [])).toBe('');
	expect(stateText('working', [], ['Robot UR10'])).toBe('Needs help: Robot UR10');
	expect(stateText('silent', ['Smart nutrunner'], ['Robot UR10'])).toBe('No contact: Smart nutrunner');
	expect(stateText('held', ['Smart nutrunner'], ['Robot UR10'])).toBe('Held: keep clear');
});
