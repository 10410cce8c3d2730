/** How it stands with the backups: whether there is one to go back to, how old it is, and how files are spoken of. */
import type { Backup, Backups } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';

/** What a station could go back to. */
export type Standing = 'none' | 'old' | 'fine';

/** Whether a backup can be restored, as far as is known. */
export function isWhole({ content, checked }: Backup): boolean {
	return content !== null && checked?.whole !== false;
}

/** When the newest was made that can be restored, in seconds since the epoch; null where there is none. */
export function newestOf(backups: readonly Backup[]): number | null {
	const times = backups.filter(isWhole).map(({ content }) => content?.time ?? 0);
	return times.length === 0 ? null : Math.max(...times);
}

/** How it stands at `now`, in seconds since the epoch. */
export function standingOf({ backups, old_after }: Pick<Backups, 'backups' | 'old_after'>, now: number): Standing {
	const newest = newestOf(backups);
	if (newest === null) return 'none';
	return now - newest > old_after ? 'old' : 'fine';
}

const UNITS = ['byte', 'kilobyte', 'megabyte', 'gigabyte', 'terabyte'] as const;

/** A size of `bytes`, in the largest unit of which there is one: `1.2 GB`. */
export function sizeText(bytes: number): string {
	const power = Math.min(UNITS.length - 1, Math.floor(Math.log10(Math.max(1, bytes)) / 3));
	const options = { style: 'unit', unit: UNITS[power] ?? 'byte', unitDisplay: 'short', maximumSignificantDigits: 3 } as const;
	return new Intl.NumberFormat(say().locale, options).format(bytes / 1000 ** power);
}

/** Who has made a backup, or how it came about. */
export function makerText({ content }: Backup): string {
	if (content === null || content.how === null) return '–';
	return say().backups.makers[content.how](content.by ?? '');
}
