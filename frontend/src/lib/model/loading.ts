/** The editors, read when the first of them is shown. */
let loading: Promise<typeof import('./editor.ts')> | undefined;

export function editors(): Promise<typeof import('./editor.ts')> {
	loading ??= import('./editor.ts');
	return loading;
}
