/** What the check found stands below the form of Model now: older links lead on. */
import { redirect } from '@sveltejs/kit';

export function load(): never {
	redirect(308, '/model?panel=problems');
}
