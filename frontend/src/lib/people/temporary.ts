/** Temporary passwords that can be read out and typed on any keyboard. */

/** Letters and figures that are not taken for one another. */
const LETTERS = 'abcdefghjkmnpqrstuvwxyz23456789';
const GROUPS = 4;
const LENGTH = 4;

/** `k7dm-x2pa-…`, from bytes that cannot be guessed; about 79 bits. */
export function temporaryPassword(random: (bytes: Uint8Array<ArrayBuffer>) => Uint8Array = fromSystem): string {
	const letters: string[] = [];
	// Bytes beyond the largest multiple of the number of letters would make some letters likelier than others.
	const fair = 256 - (256 % LETTERS.length);
	while (letters.length < GROUPS * LENGTH)
		for (const byte of random(new Uint8Array(32))) if (byte < fair) letters.push(LETTERS.charAt(byte % LETTERS.length));
	return Array.from({ length: GROUPS }, (_, n) => letters.slice(n * LENGTH, (n + 1) * LENGTH).join('')).join('-');
}

function fromSystem(bytes: Uint8Array<ArrayBuffer>): Uint8Array {
	return crypto.getRandomValues(bytes);
}
