import '#lib/testing/texts.ts';
import { expect, test } from 'vitest';
import type { Backup } from '#lib/contract.ts';
import { makerText, newestOf, sizeText, standingOf } from './standing.ts';

const CHECKED = { time: 101, by: 'Ada', whole: true, detail: '' };

function made(time: number, more: Partial<Backup> = {}): Backup {
	const content = {
		time,
		how: 'asked',
		by: 'Ada',
		program: '0.1.0',
		station: 'press',
		database: 'sqlite',
		audit: 3,
		run: 30,
		model_files: 2,
		revisions: true
	} as const;
	return { file: `${time}.tar`, size: 10, content, wrong: null, checked: CHECKED, restoring: null, ...more };
}

test('only what can be restored counts, and it is old after the time that the server says', () => {
	const broken = made(400, { checked: { ...CHECKED, whole: false } });
	const unread = made(0, { content: null, wrong: 'it is no backup' });
	const backups = [broken, made(300, { checked: null }), made(100), unread];
	expect(newestOf(backups)).toBe(300);
	expect([299, 310, 310.1].map((now) => standingOf({ backups, old_after: 10 }, now))).toEqual(['fine', 'fine', 'old']);
	expect(newestOf([broken, unread])).toBeNull();
	expect(standingOf({ backups: [broken, unread], old_after: 10 }, 401)).toBe('none');
	expect(standingOf({ backups: [], old_after: 10 }, 401)).toBe('none');
});

test('a size is told in the unit that suits it', () => {
	expect([0, 999, 1000, 12_345_678, 1.5e12, 1.5e15].map(sizeText)).toEqual(['0 byte', '999 byte', '1 kB', '12.3 MB', '1.5 TB', '1,500 TB']);
});

test('who has made it is told, or that nobody asked', () => {
	const by = (how: 'asked' | 'schedule' | 'command-line' | null): string => {
		const { content } = made(1);
		return makerText(made(1, { content: content && { ...content, how } }));
	};
	expect([by('asked'), by('schedule'), by('command-line'), by(null)]).toEqual(['Ada', 'by itself', 'Ada, at the command line', '–']);
	expect(makerText(made(1, { content: null }))).toBe('–');
});
