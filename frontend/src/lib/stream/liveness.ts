/**
 * May what is shown be taken for the station as it is now?
 *
 * While all is well the controller shows itself ten times a second, and never less than twice. Anything older than
 * `OLD_AFTER` is old, whatever the reason; the reasons that are known sooner (connection closed, controller lost, a message missing) count at
 * once.
 */
import { ageOf, type Hearing } from './hearing.ts';
import type { Stream } from './receive.ts';

/** Milliseconds; with the page's own refresh, and on a busy machine, a view that died says so well within 2 s. */
export const OLD_AFTER = 1300;

export type Cause = 'connecting' | 'closed' | 'controller' | 'gap' | 'silent';

export type Liveness =
	| { readonly live: true; readonly age: number }
	| { readonly live: false; readonly age: number | null; readonly cause: Cause };

/** What a stream says of itself; the view may be any document. */
export type Told = Pick<Stream, 'controller' | 'gap'> & { readonly view: object | null };

/** Judges what is known at `now` (milliseconds on the clock of `hearing`). */
export function judge(stream: Told, hearing: Hearing, open: boolean, now: number): Liveness {
	const age = ageOf(hearing, now);
	if (!open) return { live: false, age, cause: 'closed' };
	if (stream.controller === 'lost') return { live: false, age, cause: 'controller' };
	if (stream.view === null || age === null) return { live: false, age, cause: 'connecting' };
	if (!hearing.proven && age <= OLD_AFTER) return { live: false, age, cause: 'connecting' };
	if (stream.gap) return { live: false, age, cause: 'gap' };
	// What cannot be compared is no sign of life.
	return age <= OLD_AFTER ? { live: true, age } : { live: false, age, cause: 'silent' };
}
