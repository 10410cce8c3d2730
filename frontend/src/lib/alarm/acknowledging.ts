/** To acknowledge several alarms, each as it was shown. */
import type { Refusal } from '#lib/rest/refusal.ts';
import { wordsOf } from '#lib/text/message.ts';
import { isNew, type Alarms, type Keyed } from './priority.ts';

/** One that was not acknowledged, and why. */
export interface Left {
	readonly key: string;
	readonly text: string;
	readonly refusal: Refusal;
}

/**
 * Acknowledges `shown` one after the other with `send`; what was refused. Where the server is not reached, or nobody may go
 * on, the rest is not tried.
 */
export async function acknowledgeEach(
	shown: readonly Keyed[],
	send: (key: string, alarm: Keyed[1]) => Promise<Refusal | null>
): Promise<Left[]> {
	const left: Left[] = [];
	for (const [key, alarm] of shown) {
		const refusal = await send(key, alarm);
		if (refusal === null || refusal.kind === 'alarm-gone') continue;
		left.push({ key, text: wordsOf(alarm).text, refusal });
		if (refusal.status !== 409) break;
	}
	return left;
}

/** How one that was shown stands by now: as it was, come again since, or past being acknowledged. */
export function standsAs([key, shown]: Keyed, now: Alarms): 'same' | 'moved' | 'gone' {
	const alarm = now[key];
	if (alarm === undefined) return 'gone';
	if (alarm.since !== shown.since) return 'moved';
	return isNew(alarm) ? 'same' : 'gone';
}
