/** What is said of an operation that is not done. */
import type { Operation, StationView } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import type { Text } from '#lib/text/text.svelte.ts';
import { durationText } from '#lib/wording/time.ts';
import type { OperationStanding } from './standing.ts';

/** Until when an active one is under way and for how long it has been, or what another waits for. */
export function saidOf(operation: Operation, standing: OperationStanding, now: number, mode: StationView['mode'], texts: Text['operate']['operations']): string {
	const { active, active_since, goal, precondition, sentence } = operation;
	const what = sentence ? told(sentence, active ? goal : precondition) : '';
	if (!active) return what === '' ? texts.soAlready : what;
	if (standing === 'waits') return mode === 'automatic' ? texts.startFirst : texts.modeFirst;
	// Since when it stands is said above the plan.
	const parts = standing === 'stopped' ? [texts.stopped, what] : [what, durationText(now - (active_since ?? now))];
	return parts.filter((part) => part !== '').join(' · ');
}
