/** Where other pages show the same thing. */

/** The line of a file on the page Model. */
export function addressInModel({ file, line }: { readonly file: string; readonly line: number }): string {
	return `/model?${new URLSearchParams({ file, line: String(line) })}`;
}
