/** What went otherwise than a person expects while an order was worked. */
import type { JobResponse } from '#lib/contract.ts';
import type { Names } from '#lib/history/names.ts';
import { partOf, textsOf, titleOf, told } from '#lib/history/told.ts';
import { say } from '#lib/text/text.svelte.ts';

type Deviation = JobResponse['deviations'][number];

/** A plan that is made anew is how a station works, and of an alarm it is told once that it came. */
function matters({ kind, content }: Deviation): boolean {
	if (kind === 'alarm') return (partOf(content, 'what') ?? content)['event'] === 'came';
	return kind !== 'replanned';
}

export interface ToldDeviation {
	readonly record: number;
	readonly time: number;
	/** What happened; of an alarm what leads. */
	readonly what: string;
	/** Why, or who did it. */
	readonly about: string;
}

/** Each with its time and in words, as they came. */
export function deviationsOf({ deviations }: Pick<JobResponse, 'deviations'>, names: Names): ToldDeviation[] {
	return deviations.filter(matters).map(({ record, time, kind, content }) => {
		if (kind === 'given-up') {
			const abilities = textsOf(content['abilities']).map(names.ability).join(', ');
			return { record, time, what: `${say().history.words.given_up}: ${abilities}`, about: '' };
		}
		const found = told({ kind, content }, names);
		const what = kind === 'alarm' ? found.on : titleOf(found);
		return { record, time, what, about: [found.who, found.why, found.outcome].filter(Boolean).join(' · ') };
	});
}
