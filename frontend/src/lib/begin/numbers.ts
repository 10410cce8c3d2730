/** Numbers in a line, as the angles of a robot's joints are written. */

/** As many as a pose can have, and as large as one can be. */
const MOST = 32;
const LARGEST = 1e6;

/**
 * The numbers of a line with commas or blanks between; null where something else is in it. With semicolons between, a comma is
 * the point of a number.
 */
export function readNumbers(text: string): number[] | null {
	const line = text.replace(/^\s*\[|\]\s*$/g, '');
	const parts = (line.includes(';') ? line.replaceAll(',', '.') : line).split(/[\s,;]+/).filter(Boolean);
	const numbers = parts.map((part) => (/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(part) ? Number(part) : NaN));
	return numbers.length <= MOST && numbers.every((each) => Math.abs(each) <= LARGEST) ? numbers : null;
}

/** Numbers as they are written in a line, to a millionth. */
export function numbersText(numbers: readonly number[]): string {
	return numbers.map((each) => String(Math.round(each * 1e6) / 1e6)).join(', ');
}
