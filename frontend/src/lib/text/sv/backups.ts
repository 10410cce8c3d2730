import type { Text } from '../text.svelte.ts';

export const backups: Text['backups'] = {
	standing: 'Läget',
	none: 'Det finns ingen säkerhetskopia. Går disken sönder är allt som är känt om stationen förlorat.',
	noneWhole: 'Det finns ingen säkerhetskopia som är hel.',
	old: (since) => `Den nyaste säkerhetskopian är gammal: den gjordes ${since}.`,
	fine: (since) => `Den nyaste säkerhetskopian gjordes ${since}.`,
	make: 'Gör en säkerhetskopia nu',
	doing: { 'make-backup': 'En säkerhetskopia görs', 'check-backup': 'En säkerhetskopia kontrolleras' },
	busy: (doing, name, step) => `${doing} för ${name}: ${step} …`,
	begun: (since) => `började ${since}`,
	steps: { copying: 'kopierar databasen', writing: 'skriver filen', checking: 'läser allt' },
	beginning: 'börjar',
	troubled: 'Ingen säkerhetskopia kan göras nu.',
	ended: {
		'make-backup': {
			done: 'Den senaste gjordes och är hel',
			failed: 'Den senaste kunde inte göras',
			requested: 'Den senaste blev inte färdig, eftersom servern avslutades innan dess. Gör en till'
		},
		'check-backup': {
			done: 'Den kontrollerades och är hel',
			failed: 'Kontrollen misslyckades',
			requested: 'Kontrollen blev inte färdig, eftersom servern avslutades innan dess. Kontrollera igen'
		}
	},
	lastOf: (words, file, name, time) => `${words} (${file}, för ${name}, ${time}).`,
	remedies: {
		'no-space': 'Gör plats på disken, eller starta stationen med en mapp på en annan (--backup-folder).',
		'no-folder': 'Skapa mappen eller montera dess disk, eller starta stationen med en annan (--backup-folder).',
		'not-writable': 'Låt användaren som kör stationen skriva i mappen.',
		'no-program': 'Installera PostgreSQL:s klient, som har pg_dump, på stationens maskin.',
		'not-whole': 'Se efter om disken är hel, och gå efter en säkerhetskopia som är hel.',
		other: 'Resten står i serverns logg.'
	},
	where: 'Var de finns',
	folder: 'Mapp',
	free: 'Ledigt där',
	kept: 'Behålls',
	keptMeans: (count) => `${count === 1 ? 'den nyaste' : `de ${count} nyaste`}; en äldre tas bort först när en nyare har lästs igen och är hel`,
	schedule: 'Av sig själv',
	everyHours: (hours) => (hours === 1 ? 'varje timme' : `med ${hours} timmars mellanrum`),
	never: 'aldrig, eftersom stationen startades utan --backup-every',
	sameDisk: 'Mappen ligger på databasens disk: går den sönder är båda förlorade. Ha kopior på en annan maskin.',
	noDownload:
		'En säkerhetskopia har lösenordshashar och vem som gjort vad, så den kan inte laddas ner. Den som får läsa mappen på maskinen kopierar den därifrån, till en plats lika sluten som databasen.',
	list: 'Säkerhetskopior',
	when: 'När',
	by: 'Av',
	makers: {
		asked: (name) => name,
		schedule: (_name) => 'av sig själv',
		'command-line': (name) => `${name}, på kommandoraden`
	},
	size: 'Storlek',
	contains: 'Vad den har',
	records: (run, audit) => `journalen till och med post ${run} om vad som hänt och ${audit} om vem som gjort vad`,
	files: (count, revisions) => `${count === 1 ? '1 fil' : `${count} filer`} i modellen${revisions ? ' och dess revisioner' : ''}`,
	program: 'Version',
	whole: 'Kontrollerad',
	isWhole: (since) => `hel, läst ${since}`,
	isNotWhole: (since) => `inte hel, läst ${since}`,
	notChecked: 'inte kontrollerad',
	unreadable: 'kan inte läsas',
	acts: 'Vad som kan göras',
	check: 'Kontrollera',
	checkOf: (file) => `Kontrollera ${file}`,
	restore: 'Återställa',
	restoreAbout: 'En säkerhetskopia återställs på kommandoraden, medan allt är stoppat; härifrån kan inget återställas.',
	which: 'Säkerhetskopia att återställa',
	stop: 'Stoppa stationen, och alla som står i reserv för den.',
	away: (user) => `Ge det som finns där andra namn, på stationens maskin och som användaren ${user}. Nycklarna bredvid databasen stannar där de är.`,
	awayCommand: 'För att flytta undan det som finns',
	put: 'Sätt säkerhetskopian i dess ställe; den verifieras innan. En modell som är en annan än i säkerhetskopian vägras: flytta då undan dess mapp.',
	putCommand: 'För att återställa säkerhetskopian',
	password: 'Det finns inget lösenord i kommandona: ge databasens i PGPASSWORD eller PGPASSFILE.',
	start: 'Starta stationen som förut. Alla loggar in på nytt. Personer, nycklar och klockor som har stängts ute sedan dess är inte det längre: stäng ute dem igen.'
};
