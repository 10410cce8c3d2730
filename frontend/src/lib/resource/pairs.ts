/**
 * Which measured value answers which command, so that a resource shows both in one row: `pose` and the commanded
 * `target_pose`.
 *
 * The model does not say this, and the station does not need it: the names do, as far as engineers choose them alike.
 * It decides only what stands beside what; a variable without a partner has a row of its own.
 */
import type { Variable } from '#lib/contract.ts';

export type Named = readonly [name: string, variable: Variable];

export interface Row {
	readonly name: string;
	readonly variable: Variable;
	/** The command that this measured variable answers. */
	readonly command: Named | null;
}

/** Words that say that something is commanded or measured, not what. */
const FORM = new Set(['is', 'set', 'target', 'command', 'commanded', 'measured', 'actual']);
/** The least likeness of two names that belong together. */
const ALIKE = 0.6;

/** The rows of a resource: variables in their order, commands folded into what answers them. */
export function inRows(variables: readonly Named[]): Row[] {
	const outputs = variables.filter(([, variable]) => variable.kind === 'output');
	const answers = outputs.map((output) => answerOf(output, variables));
	// Of two commands that are answered by the same value neither is folded: which one moved it cannot be told.
	const alone = (answer: string | null): boolean => answers.filter((other) => other === answer).length === 1;
	const commands = new Map<string, Named>();
	outputs.forEach((output, index) => {
		const answer = answers[index] ?? null;
		if (answer !== null && alone(answer)) commands.set(answer, output);
	});
	const folded = new Set([...commands.values()].map(([name]) => name));
	return variables
		.filter(([name]) => !folded.has(name))
		.map(([name, variable]) => ({ name, variable, command: commands.get(name) ?? null }));
}

/** The measured variable that `output` commands: of the same resource, with common values, and of the likest name. */
function answerOf([name, output]: Named, variables: readonly Named[]): string | null {
	const ranked = variables
		.filter(([, other]) => other.kind === 'measured' && other.resource === output.resource)
		.filter(([, other]) => other.domain.some((value) => output.domain.includes(value)))
		.map(([other]) => ({ other, likeness: likeness(words(name), words(other)) }))
		.sort((a, b) => b.likeness - a.likeness);
	const [best, second] = ranked;
	if (best === undefined || best.likeness < ALIKE || best.likeness === second?.likeness) return null;
	return best.other;
}

/** The words of a name that say what it is about; those of form only where there are no others. */
function words(name: string): string[] {
	const all = name.slice(name.lastIndexOf('.') + 1).split(/[^\p{L}\p{N}]+/u);
	const telling = all.filter((word) => word !== '' && !FORM.has(word));
	return telling.length > 0 ? telling : all;
}

/** Share of words that both have, from 0 to 1; `run` and `running` are one word. */
function likeness(a: readonly string[], b: readonly string[]): number {
	const same = (x: string, y: string): boolean =>
		x === y || (Math.min(x.length, y.length) >= 3 && (x.startsWith(y) || y.startsWith(x)));
	const [few, many] = a.length < b.length ? [a, b] : [b, a];
	const common = few.filter((x) => many.some((y) => same(x, y))).length;
	return common / (a.length + b.length - common);
}
