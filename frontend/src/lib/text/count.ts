/** A number with what is counted, in the right form: `3 starts`, `1 start`. */
export function count(n: number, one: string, many: string): string {
	return `${n} ${n === 1 ? one : many}`;
}
