/**
 * Which browser the tests drive: the one named by `CHROMIUM`, else the first found on the path.
 *
 * Of the same engine the headless shell comes first: it has no windows of its own, and needs three fifths of the processor.
 */
import { accessSync, constants } from 'node:fs';
import { delimiter, join } from 'node:path';

const NAMES = ['chromium-headless-shell', 'chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'];

function executable(path: string): boolean {
	try {
		accessSync(path, constants.X_OK);
		return true;
	} catch {
		return false;
	}
}

/** Path of a Chromium; an error in words when there is none. */
export function chromium(): string {
	const named = process.env['CHROMIUM'];
	if (named) return named;
	const folders = (process.env['PATH'] ?? '').split(delimiter);
	const found = NAMES.flatMap((name) => folders.map((folder) => join(folder, name))).find(executable);
	if (found === undefined) throw new Error('No Chromium on the path: install one, or name it in CHROMIUM.');
	return found;
}
