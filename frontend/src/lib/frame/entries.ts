/** What the palette can lead to or do: pages, variables, abilities, operations, alarms, and what is possible now. */
import { addressOf as abilityAddress } from '#lib/ability/address.ts';
import { MENU, WITHIN, type Page } from '#lib/account/pages.ts';
import type { Session } from '#lib/account/session.svelte.ts';
import { byUrgency } from '#lib/alarm/priority.ts';
import { setCycleStop, setMode, startProduction, takeControl, releaseControl } from '#lib/command/send.ts';
import type { StationView } from '#lib/contract.ts';
import { standingsOf, type OperationStanding } from '#lib/operation/standing.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { wordsOf } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { fullName } from '#lib/wording/names.svelte.ts';
import { pagesFor } from './shown.ts';

/** Of more of a group the reader would not look at the others. */
const MOST = 8;

export type Group = 'act' | 'page' | 'alarm' | 'operation' | 'ability' | 'variable';

export interface Entry {
	readonly group: Group;
	readonly text: string;
	/** What else it is found by, and told from others of that text. */
	readonly name: string;
	/** The page that it leads to. */
	readonly page?: Page['title'];
	/** Where it leads, what it does, or of which operation it asks why that waits. */
	readonly does: { readonly to: string } | { readonly run: () => Promise<Refusal | null> } | { readonly why: string };
}

interface Known {
	readonly session: Session;
	readonly view: StationView | null;
	/** Whether this session has control. */
	readonly mine: boolean;
}

/** What is possible now, without anything further to say. */
function acts({ session, view, mine }: Known): Entry[] {
	const { pause, hold, goOn, start } = say().frame;
	const after = say().figures.after;
	const { take, release } = say().account.control;
	if (view === null || !session.may('operator')) return [];
	const act = (name: string, text: string, run: () => Promise<Refusal | null>, possible: boolean): Entry[] =>
		possible ? [{ group: 'act', text, name, does: { run } }] : [];
	const working = view.mode === 'automatic' && view.production === 'started';
	const stopped = view.mode === 'paused' || view.mode === 'hold';
	return [
		...act('start', start, startProduction, mine && view.production === 'waiting'),
		...act('continue', goOn, () => setMode('automatic'), mine && stopped),
		...act('pause', pause, () => setMode('paused'), !stopped),
		...act('pause-after', after.full, () => setCycleStop(true), working && view.cycle_stop === null),
		...act('pause-after', after.not, () => setCycleStop(false), working && mine && view.cycle_stop !== null),
		...act('hold', hold, () => setMode('hold'), view.mode !== 'hold'),
		...act('take', take, () => takeControl(null, ''), view.control === null),
		...act('release', release, releaseControl, mine)
	];
}

/** All that there is, in the order in which it is offered before anything is typed. */
export function entriesOf(known: Known): Entry[] {
	const { session, view } = known;
	const standings = view === null ? new Map<string, OperationStanding>() : standingsOf(view);
	const pages = [...pagesFor(session).flatMap((group) => group.pages), ...[...WITHIN, ...MENU].filter(({ role }) => session.may(role))];
	return [
		...acts(known),
		...pages.map(({ title, address }): Entry => ({ group: 'page', text: say().pages[title], name: title, page: title, does: { to: address } })),
		{ group: 'page', text: say().frame.palette.examples, name: 'examples', page: 'model', does: { to: '/model?examples=on' } },
		...byUrgency(view?.alarms ?? {}).map(
			([key, alarm]): Entry => ({ group: 'alarm', text: wordsOf(alarm).text, name: key, does: { to: '/alarms' } })
		),
		...Object.entries(view?.operations ?? {}).map(
			([name, { title }]): Entry => ({ group: 'operation', text: say().frame.palette.why[standings.get(name) ?? 'waits'](title), name, does: { why: name } })
		),
		...Object.entries(view?.abilities ?? {}).map(
			([name, { title }]): Entry => ({ group: 'ability', text: title, name, does: { to: abilityAddress(name) } })
		),
		...Object.keys(view?.variables ?? {}).map(
			(name): Entry => ({ group: 'variable', text: fullName(view, name), name, does: { to: `/state?search=${encodeURIComponent(name)}` } })
		)
	];
}

/** How well `entry` fits `words`: 0 where one is nowhere in it, more where they begin it, most where they begin its first word. */
function fit({ text, name }: Entry, words: readonly string[]): number {
	const said = `${text} ${name}`.toLowerCase();
	let best = 3;
	for (const word of words) {
		const at = said.indexOf(word);
		if (at < 0) return 0;
		if (at > 0) best = Math.min(best, /[\p{L}\p{N}]/u.test(said[at - 1] ?? '') ? 1 : 2);
	}
	return best;
}

/** Those in which all the words typed are, the best first in each group; before anything is typed acts, pages and alarms. */
export function found(entries: readonly Entry[], typed: string): [Group, Entry[]][] {
	const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
	const groups = new Map<Group, { entry: Entry; fits: number }[]>();
	for (const entry of entries) {
		if (words.length === 0 && !['act', 'page', 'alarm'].includes(entry.group)) continue;
		const fits = fit(entry, words);
		if (fits > 0) groups.set(entry.group, [...(groups.get(entry.group) ?? []), { entry, fits }]);
	}
	return [...groups].map(([group, among]) => {
		const sorted = among.toSorted((a, b) => b.fits - a.fits).map(({ entry }) => entry);
		return [group, words.length === 0 ? sorted : sorted.slice(0, MOST)];
	});
}
