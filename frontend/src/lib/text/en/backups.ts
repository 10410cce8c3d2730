/** Backups of the station: which there are, how old they are, and how one is restored. */
export const backups = {
	standing: 'How it stands',
	none: 'There is no backup. If the disk fails, all that is known of the station is lost.',
	noneWhole: 'There is no backup that is whole.',
	old: (since: string): string => `The newest backup is old: it was made ${since}.`,
	fine: (since: string): string => `The newest backup was made ${since}.`,
	make: 'Make a backup now',
	doing: { 'make-backup': 'A backup is being made', 'check-backup': 'A backup is being checked' },
	busy: (doing: string, name: string, step: string): string => `${doing} for ${name}: ${step} …`,
	begun: (since: string): string => `begun ${since}`,
	steps: { copying: 'copying the database', writing: 'writing the file', checking: 'reading all of it' },
	beginning: 'beginning',
	troubled: 'A backup cannot be made now.',
	ended: {
		'make-backup': {
			done: 'The last one was made, and is whole',
			failed: 'The last one could not be made',
			requested: 'The last one was not finished, as the server has ended before. Make another'
		},
		'check-backup': {
			done: 'It was checked, and is whole',
			failed: 'The check has failed',
			requested: 'The check was not finished, as the server has ended before. Check it again'
		}
	},
	lastOf: (words: string, file: string, name: string, time: string): string => `${words} (${file}, for ${name}, ${time}).`,
	remedies: {
		'no-space': 'Make room on the disk, or start the station with a folder on another one (--backup-folder).',
		'no-folder': 'Make the folder or mount its disk, or start the station with another one (--backup-folder).',
		'not-writable': 'Let the user who runs the station write to the folder.',
		'no-program': 'Install PostgreSQL’s client, which has pg_dump, on the machine of the station.',
		'not-whole': 'See whether the disk is sound, and go by a backup that is whole.',
		other: 'The log of the server has the rest.'
	},
	where: 'Where they are',
	folder: 'Folder',
	free: 'Free there',
	kept: 'Kept',
	keptMeans: (count: number): string => `${count === 1 ? 'the newest' : `the newest ${count}`}; an older one goes only after a newer one was read again and is whole`,
	schedule: 'By itself',
	everyHours: (hours: number): string => (hours === 1 ? 'every hour' : `every ${hours} hours`),
	never: 'never, as the station was started without --backup-every',
	sameDisk: 'The folder is on the disk of the database: if that fails, both are lost. Keep copies on another machine.',
	noDownload:
		'A backup has password hashes and who did what, so it cannot be downloaded. Anyone who may read the folder on the machine copies it from there, to a place as closed as the database.',
	list: 'Backups',
	when: 'When',
	by: 'By',
	makers: {
		asked: (name: string): string => name,
		schedule: (_name: string): string => 'by itself',
		'command-line': (name: string): string => `${name}, at the command line`
	},
	size: 'Size',
	contains: 'What is in it',
	records: (run: number, audit: number): string => `the journal up to record ${run} of what happened and ${audit} of who did what`,
	files: (count: number, revisions: boolean): string => `${count === 1 ? '1 file' : `${count} files`} of the model${revisions ? ' and its revisions' : ''}`,
	program: 'Version',
	whole: 'Checked',
	isWhole: (since: string): string => `whole, read ${since}`,
	isNotWhole: (since: string): string => `not whole, read ${since}`,
	notChecked: 'not checked',
	unreadable: 'cannot be read',
	acts: 'What can be done',
	check: 'Check',
	checkOf: (file: string): string => `Check ${file}`,
	restore: 'Restore',
	restoreAbout: 'A backup is restored at the command line, while everything is stopped; nothing can be restored from here.',
	which: 'Backup to restore',
	stop: 'Stop the station, and all that stand by for it.',
	away: (user: string): string => `On its machine, as the user ${user}, give what is there other names. The keys beside the database stay where they are.`,
	awayCommand: 'To move away what is there',
	put: 'Put the backup in its place; it is verified before. A model that is another one than in the backup is refused: move its folder away then.',
	putCommand: 'To restore the backup',
	password: 'There is no password in the commands: give that of the database in PGPASSWORD or PGPASSFILE.',
	start: 'Start the station as before. Everybody signs in again. People, keys and watches that were locked out since then are no longer so: lock them out again.'
};
