/** The question whether control is taken over, which stays while what has asked it moves to another place of the frame. */
import type { Control } from '#lib/contract.ts';

class TakingOver {
	/** From whom, as read when the question was opened; null while nothing is asked. */
	from = $state.raw<Control | null>(null);
}

export const takingOver = new TakingOver();
