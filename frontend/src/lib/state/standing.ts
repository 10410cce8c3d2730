/** What is not as it should be with a value: nobody knows it, nobody has confirmed it, somebody has forced it, or it is in doubt. */
import type { Question, StationView, Variable } from '#lib/contract.ts';
import { isUnconfirmed } from '#lib/restart/shown.ts';

export const STANDINGS = ['unknown', 'unconfirmed', 'forced', 'doubted'] as const;
export type Standing = (typeof STANDINGS)[number];

/** The part of the view that says so. */
export type Judged = Pick<StationView, 'variables' | 'forces' | 'questions'>;

/** The questions by what they are about. */
export function doubtsOf(questions: readonly Question[]): ReadonlyMap<string, Question> {
	return new Map(questions.map((question) => [question.variable, question]));
}

/** Says whether a variable has a standing. */
export function standingIn(view: Judged): (name: string, variable: Variable, standing: Standing) => boolean {
	const doubts = doubtsOf(view.questions);
	return (name, variable, standing) => {
		switch (standing) {
			case 'unknown':
				return variable.value === null;
			case 'unconfirmed':
				return isUnconfirmed(variable);
			case 'forced':
				return Object.hasOwn(view.forces, name);
			case 'doubted':
				return doubts.has(name);
		}
	};
}

/** How many variables have each standing. */
export function countsOf(view: Judged): Record<Standing, number> {
	const has = standingIn(view);
	const counts = { unknown: 0, unconfirmed: 0, forced: 0, doubted: 0 };
	for (const [name, variable] of Object.entries(view.variables))
		for (const standing of STANDINGS) if (has(name, variable, standing)) counts[standing] += 1;
	return counts;
}
