/** What has to be so before the draft can be deployed; the server has the last word. */
import type { FileMark, Revision, Revisions, StationView, Transfer, Workshop } from '#lib/contract.ts';
import { verdictOf } from '#lib/workshop/verdict.ts';

export type Need = 'saved' | 'other' | 'checked' | 'approved' | 'standing' | 'control' | 'fits';

export interface Known {
	readonly view: Pick<StationView, 'mode' | 'production' | 'errand' | 'analysis' | 'station'>;
	readonly workshop: Workshop;
	/** The revisions as they are with this draft; null while they are not known. */
	readonly revisions: Revisions | null;
	/** Whether the station can take this draft; null while that is not known. */
	readonly transfer: Transfer | null;
	/** This session has control. */
	readonly mine: boolean;
}

/** The files of the draft that are others than those of the model that runs, by path. */
export function differing(files: Readonly<Record<string, FileMark>>): [path: string, mark: FileMark][] {
	return Object.entries(files).filter(([, mark]) => mark.state !== 'same');
}

/** The revision that the draft is; null where it is not saved. */
export function savedAs(revisions: Revisions | null): Revision | null {
	return revisions?.revisions.find((each) => each.draft) ?? null;
}

/** Somebody else than who saved it has approved it, and nobody wants changes. */
export function isApproved({ approved_by, changes_requested_by }: Pick<Revision, 'approved_by' | 'changes_requested_by'>): boolean {
	return approved_by.length > 0 && changes_requested_by.length === 0;
}

/** Whether somebody else has a say in whether the draft, saved as `saved`, is deployed: as the model that runs asks for it, or as they have said something. */
export function isReviewed(view: Pick<StationView, 'station'>, saved: Revision | null): boolean {
	return view.station.deployment_approval === 'dual' || (saved !== null && saved.approved_by.length + saved.changes_requested_by.length > 0);
}

/** Nothing of the model that is there can run, so nothing need be stopped, and nobody need be in control. */
export function isUnrun({ production, analysis }: Pick<StationView, 'production' | 'analysis'>): boolean {
	return production === 'preparing' && analysis?.supervised === false;
}

/** Nothing is started by itself. */
export function isStanding(view: Pick<StationView, 'mode' | 'production' | 'errand' | 'analysis'>): boolean {
	if (isUnrun(view)) return true;
	if (view.production === 'preparing' || view.errand !== null) return false;
	return !(view.production === 'started' && view.mode === 'automatic');
}

/** The titles of what runs now, or of those of it that are `among` these: all that is said of it comes from here. */
export function runningOf({ abilities }: Pick<StationView, 'abilities'>, among?: readonly string[]): string[] {
	return Object.entries(abilities)
		.filter(([name, ability]) => ability.running_since !== null && (among?.includes(name) ?? true))
		.map(([, ability]) => ability.title);
}

/** All that is needed, in the order in which a person brings it about, and whether it is so. */
export function needsOf({ view, workshop, revisions, transfer, mine }: Known): [need: Need, met: boolean][] {
	const { check, number, files } = workshop;
	const saved = savedAs(revisions);
	const approval: [Need, boolean][] = view.station.deployment_approval === 'dual' ? [['approved', saved !== null && isApproved(saved)]] : [];
	return [
		['other', differing(files).length > 0],
		['saved', saved !== null],
		['checked', check.number === number && verdictOf(check) === 'good'],
		...approval,
		['fits', transfer?.legal === true],
		['control', mine || isUnrun(view)],
		['standing', isStanding(view)]
	];
}

export type Fate = 'new' | 'gone' | 'anew';

/** What becomes of a variable that does not go on as it is. */
export function fateOf({ before, after }: Transfer['changes'][number], known: boolean): Fate {
	if (!known) return 'new';
	return after === null && before !== null ? 'gone' : 'anew';
}

/**
 * Only that the station works by itself is in the way: to pause it, and to wait for what would be another one in the new
 * model, is all that this takes.
 */
export function onlyPauses(
	needs: readonly (readonly [need: Need, met: boolean])[],
	view: Pick<StationView, 'production' | 'errand'>,
	transfer: Transfer | null
): boolean {
	const missing = needs.filter(([, met]) => !met).map(([need]) => need);
	if (!missing.includes('standing') || view.errand !== null || view.production !== 'started') return false;
	return missing.every((need) => need === 'standing' || (need === 'fits' && waitsOnly(transfer)));
}

/** It does not fit only as long as something runs that is another one there. */
function waitsOnly(transfer: Transfer | null): boolean {
	return transfer !== null && transfer.obstacle === null && transfer.violated.length === 0 && transfer.under_way.length > 0;
}
