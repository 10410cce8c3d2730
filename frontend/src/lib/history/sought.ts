/** Which of what happened is shown: of which kind, by whom, on what, with what text. */
import type { AuditRecord, StationView } from '#lib/contract.ts';

export const KINDS = ['note', 'people', 'mode', 'plan', 'work', 'hand', 'alarm', 'controller', 'every'] as const;
export type Kind = (typeof KINDS)[number];

export interface Sought {
	readonly kind: Kind;
	/** Id and name of who acted; null for everybody. */
	readonly who: { readonly id: string; readonly name: string } | null;
	/** The resource, or empty for all. */
	readonly resource: string;
	readonly text: string;
}

export const EVERYTHING_OF_NOTE: Sought = { kind: 'note', who: null, resource: '', text: '' };

/** The most ids that are asked for because their titles have the text. */
const MOST_IDS = 90;

const MODE = ['production-started', 'mode-changed', 'called-off', 'stepping-changed', 'step-taken', 'errand-taken', 'errand-stopped'];
const HAND = ['corrected', 'confirmed', 'forced', 'force-released', 'service-changed', 'by-hand'];
const JOBS = ['by-order-changed', 'job-taken', 'job-commanded'];
const WORK = ['started', 'ended', 'activated', 'completed', 'called_off', 'given_up'];

/** Of which kinds the records are, or which parts they have; and whether acts of people are among them. */
const CHOICES: Record<Kind, { readonly kinds: readonly string[]; readonly parts: readonly string[]; readonly acts: boolean }> = {
	note: { kinds: ['begun', 'alarm', 'unanswered', ...MODE, ...HAND, ...JOBS], parts: [...WORK, 'plan'], acts: true },
	people: { kinds: [], parts: [], acts: true },
	mode: { kinds: ['begun', ...MODE], parts: ['mode'], acts: false },
	plan: { kinds: ['unanswered', 'explained'], parts: ['plan'], acts: false },
	work: { kinds: JOBS, parts: WORK, acts: false },
	hand: { kinds: HAND, parts: [], acts: false },
	alarm: { kinds: ['alarm'], parts: [], acts: false },
	controller: { kinds: ['begun'], parts: [], acts: false },
	every: { kinds: [], parts: [], acts: true }
};

/** What is asked of `/history` for it; null where no record of the run is wanted. */
export function questionOf(sought: Sought, view: StationView | null): URLSearchParams | null {
	if (sought.kind === 'people') return null;
	const { kinds, parts } = CHOICES[sought.kind];
	const query = new URLSearchParams();
	if (kinds.length > 0) query.set('kinds', kinds.join(','));
	if (parts.length > 0) query.set('parts', parts.join(','));
	if (sought.who !== null) query.set('who', sought.who.name);
	if (sought.resource !== '') for (const name of namesOn(sought.resource, view)) query.append('name', name);
	if (sought.text !== '') for (const text of textsFor(sought.text, view)) query.append('text', text);
	return query;
}

/** Whether acts of people may be among what is sought. */
export function wantsActs({ kind }: Sought): boolean {
	return CHOICES[kind].acts;
}

/** Whether an act is among what is sought. */
export function isAct(record: AuditRecord, sought: Sought, view: StationView | null): boolean {
	if (!wantsActs(sought)) return false;
	const { entry } = record;
	if (sought.who !== null && entry.actor.id !== sought.who.id) return false;
	const text = JSON.stringify(entry).toLowerCase();
	const has = (one: string): boolean => text.includes(one.toLowerCase());
	if (sought.resource !== '' && !namesOn(sought.resource, view).some(has)) return false;
	return sought.text === '' || textsFor(sought.text, view).some(has);
}

/** What is named where something has to do with a resource: what begins so. */
function namesOn(resource: string, view: StationView | null): string[] {
	const own = `${resource}.`;
	const others = Object.entries(view?.abilities ?? {})
		.filter(([id, ability]) => ability.resource === resource && !id.startsWith(own))
		.map(([id]) => id);
	return [own, ...others.slice(0, MOST_IDS)];
}

/** The text as people and the model write it, and what has it in its title. */
function textsFor(text: string, view: StationView | null): string[] {
	const wanted = text.toLowerCase();
	const titled = [...Object.entries(view?.abilities ?? {}), ...Object.entries(view?.operations ?? {})]
		.filter(([, { title }]) => title.toLowerCase().includes(wanted))
		.map(([id]) => id);
	return [...new Set([text, text.replaceAll(' ', '_'), ...titled.slice(0, MOST_IDS)])];
}
