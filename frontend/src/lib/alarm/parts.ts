/** What has happened of an alarm, part by part. */
import type { Alarm, Argument } from '#lib/contract.ts';
import { told } from '#lib/text/message.ts';
import { say } from '#lib/text/text.svelte.ts';
import { listed } from '#lib/wording/listed.ts';

export interface Part {
	readonly text: string;
	/** Where, for an engineer, what is told of by what it is about. */
	readonly topic: string | null;
}

/** Each once. That a topic is silent is told by what it tells, as `about` calls it. */
export function partsOf(alarm: Pick<Alarm, 'parts' | 'messages'>, about: (topic: string) => readonly string[]): Part[] {
	const silences = say().alarms.silences;
	const parts = alarm.parts.map((written, index): Part => {
		const message = alarm.messages?.parts[index];
		const silence = message && silences[message.id];
		const topic = message?.arguments?.['topic'];
		if (silence === undefined || typeof topic !== 'string') return { text: told(message, written), topic: null };
		return { text: silence(listed(about(topic))) + why(message?.arguments?.['why']), topic };
	});
	return [...new Map(parts.map((part) => [`${part.text} ${part.topic ?? ''}`, part])).values()];
}

/** What may stand in brackets behind it. */
function why(argument: Argument | undefined): string {
	return typeof argument === 'object' && 'id' in argument ? told(argument, '') : '';
}
