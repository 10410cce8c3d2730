import { expect, test } from 'vitest';
import { broughtBack } from './brought.ts';

test('a code or an error is brought back, with the state that it belongs to', () => {
	expect(broughtBack('?code=c&state=s&iss=https%3A%2F%2Fid.example')).toEqual({ code: 'c', state: 's', iss: 'https://id.example' });
	expect(broughtBack('?error=access_denied&state=s&error_description=No')).toEqual({ error: 'access_denied', state: 's' });
	expect(broughtBack('?error=%3Cscript%3E&state=s')).toEqual({ error: 'unknown_error', state: 's' });
});

test('an address that no provider has sent brings nothing', () => {
	for (const search of ['', '?', '?code=c', '?state=s', '?state=&code=c', '?code=&state=s']) expect(broughtBack(search)).toBeNull();
});
