/** How what was done is said: acts, who does them, and how they ended. */
import type { Actor, AuditRecord, Outcome } from '#lib/contract.ts';
import type { Names } from '#lib/history/names.ts';
import { modeText, served } from '#lib/history/told.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { listed } from '#lib/wording/listed.ts';
import { inSentence } from '#lib/wording/names.svelte.ts';
import { titledAlone } from '#lib/wording/titled.svelte.ts';

type Details = NonNullable<AuditRecord['entry']['details']>;

/** What was done, in people's words; an act that is not known keeps its own name. */
export function actText(action: string): string {
	const acts: Readonly<Record<string, string>> = say().history.acts;
	return Object.hasOwn(acts, action) ? (acts[action] ?? action) : action;
}

/** The id under which whoever was not recognised is written. */
export const UNKNOWN = 'unknown';

/** Who acts. A name that was only claimed is told from one that was proven. */
export function actorText(actor: Actor): string {
	const text = say().history.journal;
	if (actor.id === UNKNOWN) return actor.name === UNKNOWN ? text.nobody : text.claimed(actor.name);
	switch (actor.kind) {
		case 'watch':
			return text.watch(actor.name);
		case 'key':
			return text.key(actor.name);
		case 'person':
		case 'demonstration':
		case 'system':
			return actor.name;
	}
}

/** What stands in a record in place of an address, of who acts at the machine itself. */
const COMMAND_LINE = /^the command line of (.+)$/;

/** From where somebody acts; empty where that is not written. */
export function whereText({ address }: Pick<Actor, 'address'>): string {
	const user = COMMAND_LINE.exec(address ?? '')?.[1];
	return user === undefined ? (address ?? '') : say().history.journal.commandLine(user);
}

/** What the program itself gives as its reason where it starts production. */
const BY_OPTION = 'started with --start';

/** Why somebody did it, in their words; empty where they gave no reason. */
export function reasonText({ actor, reason }: AuditRecord['entry']): string {
	return actor.kind === 'system' && reason === BY_OPTION ? say().history.journal.byOption : (reason ?? '');
}

/** How an act ended as a mark, beside its word. */
export const MARKS: Record<Outcome, string> = { requested: '◌', done: '✓', refused: '✕', failed: '▲' };

/** Why an act was refused or failed, as a refusal says it: `control-needed` → `control is needed`. Empty where that is not written. */
export function becauseText(record: AuditRecord): string {
	const because = record.entry.details?.['because'];
	return typeof because === 'string' ? inSentence(told({ id: `refused.${because}` }, because.replaceAll('-', ' '))) : '';
}

/** A detail of a record for a person to read. */
export function detailText(value: unknown): string {
	if (typeof value === 'string') return value;
	return typeof value === 'boolean' ? (value ? say().common.yes : say().common.no) : JSON.stringify(value);
}

/** The subject of a record, `task 4-1`, in the words of who reads it; one of no kind that is known as it stands. */
function subjectOf(subject: string): string {
	// Which session it was says nobody anything; it is in the record.
	if (subject.startsWith('session ')) return '';
	const kinds: Readonly<Record<string, (id: string) => string>> = say().history.journal.subjects;
	const kind = Object.keys(kinds)
		.filter((each) => subject.startsWith(`${each} `))
		.sort((a, b) => b.length - a.length)[0];
	return kind === undefined ? subject : (kinds[kind]?.(subject.slice(kind.length + 1)) ?? subject);
}

/** On what it was done, and to what it was changed where that is short. A task is called by its title, and so is a job, with its number. */
export function subjectText(record: AuditRecord, names: Pick<Names, 'variable' | 'value' | 'resource' | 'ability' | 'operation'>): string {
	const { action } = record.entry;
	const subject = subjectOf(record.entry.subject);
	const { journal, words } = say().history;
	const details = record.entry.details ?? {};
	const detail = (name: string): string => (typeof details[name] === 'string' ? details[name] : '');
	switch (action) {
		case 'set-mode':
			return modeText(detail('mode'));
		case 'acknowledge-task':
			// Its number is counted by the station itself and says nobody anything; it is in the record.
			return titledAlone(detail('title')) || subject;
		case 'take-job':
			return titled(titledAlone(detail('title')), subject);
		case 'job-order-stored':
		case 'job-order-updated':
			return titled(detail('description'), subject);
		case 'work-by-order':
			return details['on'] === true ? journal.byOrder : journal.freely;
		case 'set-stepping':
		case 'set-cycle-stop':
			return details['on'] === true ? words.on : words.off;
		case 'set-service':
			return `${served(detail('of'), detail('name'), names)}: ${details['in_service'] === true ? words.inService : words.outOfService}`;
		case 'force-variable':
			return 'value' in details ? `${names.variable(subject)}: ${names.value(subject, details['value'])}` : names.variable(subject);
		case 'release-force':
			return names.variable(subject);
		case 'person-changed':
			return [subject, ...changes(details)].join(', ');
		case 'deploy':
			return joined(subject, peopleIn(details['approved_by'], journal.approvedBy));
		case 'revision-approved':
		case 'revision-changes-requested':
		case 'revision-verdict-withdrawn':
			return joined(subject, peopleIn([details['saved_by']], journal.savedBy));
		case 'set-override':
			return [subject, ...settings(details['fields'], detailOf)].join(', ');
		case 'correct-estimates':
		case 'confirm-estimates':
		case 'decide-outputs':
			return settings(details['values'], (name, value) => `${names.variable(name)}: ${names.value(name, value)}`).join(', ') || subject;
		default:
			return subject;
	}
}

/** `Engine 4711 (job 4711)`; without a title, or with its number for one, what it is called otherwise. */
const titled = (title: string, subject: string): string =>
	title === '' || subject.endsWith(` ${title}`) ? subject : `${title} (${subject})`;

/** `revision Bolts, approved by Adam and Eva`. */
const joined = (...parts: readonly string[]): string => parts.filter((each) => each !== '').join(', ');

/** Those who are named, as `said`; empty where nobody is. */
function peopleIn(names: unknown, said: (people: string) => string): string {
	const people = Array.isArray(names) ? names.filter((each) => typeof each === 'string') : [];
	return people.length === 0 ? '' : said(listed(people));
}

/** `role: operator → engineer`, of what changed from one value to another. */
function changes(details: Details): string[] {
	return Object.entries(details).flatMap(([name, value]) =>
		Array.isArray(value) && value.length === 2 ? [`${name}: ${value.map(detailText).join(' → ')}`] : []
	);
}

/** `speed = 0.25`: a field of a device, by its name there. */
const detailOf = (name: string, value: unknown): string => `${name} = ${detailText(value)}`;

/** What was set, each as `told`. */
function settings(fields: unknown, told: (name: string, value: unknown) => string): string[] {
	if (typeof fields !== 'object' || fields === null) return [];
	return Object.entries(fields).map(([name, value]) => told(name, value));
}
