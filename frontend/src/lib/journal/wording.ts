/** How what was done is said: acts, who does them, and how they ended. */
import type { Actor, AuditRecord, Outcome } from '#lib/contract.ts';

/** The acts that are known by name, as people say them. */
export const ACTS: Readonly<Record<string, string>> = {
	'set-mode': 'Changed the mode',
	'start-production': 'Started production',
	'enter-restart': 'Entered restart mode',
	'leave-restart': 'Left restart mode',
	'set-stepping': 'Changed stepping',
	'take-step': 'Allowed one start',
	'set-service': 'Changed what is in service',
	'correct-estimates': 'Corrected estimates',
	'undo-correction': 'Took back a correction',
	'confirm-estimates': 'Confirmed estimates',
	'decide-outputs': 'Decided on outputs',
	'take-errand': 'Took a plan to be carried out',
	'stop-errand': 'Stopped what was carried out',
	'force-variable': 'Forced a variable',
	'release-force': 'Released a forced variable',
	'acknowledge-alarm': 'Acknowledged an alarm',
	'shelve-alarm': 'Shelved an alarm',
	'unshelve-alarm': 'Took an alarm off the shelf',
	'suppress-alarm': 'Took an alarm out of service',
	'restore-alarm': 'Put an alarm back into service',
	'acknowledge-task': 'Said that a task is done',
	'set-override': 'Set an override',
	'clear-override': 'Took back an override',
	'take-control': 'Took control',
	'release-control': 'Gave back control',
	'withdraw-control': 'Control was withdrawn',
	'attach-topic': 'Attached a ROS topic',
	'sign-in': 'Signed in',
	'sign-out': 'Signed out',
	'sessions-ended': 'Signed somebody out everywhere',
	'demonstration-opened': 'Opened the demonstration',
	'password-changed': 'Changed the own password',
	'password-reset': 'Gave a temporary password',
	'first-start-link': 'Made the link of the first start',
	'first-administrator': 'Became the first administrator',
	'person-created': 'Added a person',
	'person-changed': 'Changed a person',
	'key-created': 'Made a key',
	'key-revoked': 'Revoked a key',
	'watch-offered': 'Offered to pair a watch',
	'watch-offer-withdrawn': 'Withdrew an offer to pair a watch',
	'watch-redeemed': 'Typed in a pairing code',
	'watch-confirmed': 'Confirmed a watch',
	'watch-revoked': 'Refused or revoked a watch'
};

type Details = NonNullable<AuditRecord['entry']['details']>;

/** What was done, in people's words; an act that is not known keeps its own name. */
export function actText(action: string): string {
	return Object.hasOwn(ACTS, action) ? (ACTS[action] ?? action) : action;
}

/** The id under which whoever was not recognised is written. */
export const UNKNOWN = 'unknown';

/** Who acts. A name that was only claimed is told from one that was proven. */
export function actorText(actor: Actor): string {
	if (actor.id === UNKNOWN) return actor.name === UNKNOWN ? 'somebody unknown' : `somebody unknown, as “${actor.name}”`;
	switch (actor.kind) {
		case 'watch':
			return `${actor.name} (watch)`;
		case 'key':
			return `${actor.name} (key)`;
		case 'person':
		case 'demonstration':
		case 'system':
			return actor.name;
	}
}

/** How an act ended, with a mark of its own for each. */
export const OUTCOMES: Record<Outcome, { readonly mark: string; readonly word: string }> = {
	requested: { mark: '◌', word: 'end not known' },
	done: { mark: '✓', word: 'done' },
	refused: { mark: '✕', word: 'refused' },
	failed: { mark: '▲', word: 'failed' }
};

/** Why an act was refused or failed: `control-needed` → `control needed`. Empty where that is not written. */
export function becauseText(record: AuditRecord): string {
	const because = record.entry.details?.['because'];
	return typeof because === 'string' ? because.replaceAll('-', ' ') : '';
}

/** A detail of a record for a person to read. */
export function detailText(value: unknown): string {
	if (typeof value === 'string') return value;
	return typeof value === 'boolean' ? (value ? 'yes' : 'no') : JSON.stringify(value);
}

/** On what it was done, and to what it was changed where that is short. A task is called by its title. */
export function subjectText(record: AuditRecord): string {
	const { action, subject } = record.entry;
	const details = record.entry.details ?? {};
	const detail = (name: string): string => (typeof details[name] === 'string' ? details[name] : '');
	switch (action) {
		case 'set-mode':
			return detail('mode');
		case 'acknowledge-task':
			return detail('title') === '' ? subject : `${detail('title')} (${subject})`;
		case 'person-changed':
			return [subject, ...changes(details)].join(', ');
		case 'set-override':
			return [subject, ...settings(details['fields'])].join(', ');
		case 'correct-estimates':
		case 'confirm-estimates':
		case 'decide-outputs':
			return settings(details['values']).join(', ') || subject;
		default:
			return subject;
	}
}

/** `role: operator → engineer`, of what changed from one value to another. */
function changes(details: Details): string[] {
	return Object.entries(details).flatMap(([name, value]) =>
		Array.isArray(value) && value.length === 2 ? [`${name}: ${value.map(detailText).join(' → ')}`] : []
	);
}

/** `speed = 0.25`, of what was set. */
function settings(fields: unknown): string[] {
	if (typeof fields !== 'object' || fields === null) return [];
	return Object.entries(fields).map(([name, value]) => `${name} = ${detailText(value)}`);
}
