/**
 * Which questions a person still has to answer. Where somebody has looked and said that it is as believed, the station goes on
 * wondering, since what is measured fits no better; asked again nobody can say more.
 */
import type { Question, StationView } from '#lib/contract.ts';

/** The alarm that lasts as long as belief and measurement do not go together. */
const ALARM = 'contradiction';

type Seen = Pick<StationView, 'questions' | 'alarms' | 'variables'>;

function isAnswered({ alarms, variables }: Seen, { variable }: Question): boolean {
	const since = alarms[ALARM]?.since;
	const at = variables[variable]?.belief?.at;
	return since !== undefined && at !== undefined && at >= since;
}

/** Those that nobody has answered since they came up. */
export function openQuestions(view: Seen): Question[] {
	return view.questions.filter((question) => !isAnswered(view, question));
}

/**
 * What is asked at once of those that are open: what is wrong in any case by itself, since correcting it may answer the
 * others; otherwise all that may be so, since who looks sees it together.
 */
export function askedNow(open: readonly Question[]): readonly Question[] {
	const [first] = open;
	if (first === undefined) return [];
	const maybe = open.filter(({ believed, possible }) => possible.includes(believed));
	return maybe.includes(first) ? maybe : [first];
}

/** Those that were answered, and are asked all the same. */
export function answeredQuestions(view: Seen): Question[] {
	return view.questions.filter((question) => isAnswered(view, question));
}
