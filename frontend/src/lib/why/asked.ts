/** What a question why is about, and what it was asked below. */
import type { WhyNot } from '#lib/contract.ts';

export interface Asked {
	/** When the whole was asked last, in milliseconds: what is open below is then asked again. */
	readonly at: number;
	/** What has been told above, each once: it is not opened again below itself. */
	readonly above: readonly string[];
	/** What is asked about is done: the conditions are those of the next time. */
	readonly done?: boolean;
}

export const keyOf = (of: string, name: string): string => `${of} ${name}`;

/** The operation whose activity a variable is. */
export const operationOf = (variable: string): string | null => /^operation\.(.+)\.active$/.exec(variable)?.[1] ?? null;

/** The conditions that no tree tells: how the station executes, what is out of service, what is not wanted now. */
export function untold({ conditions, trees }: Pick<WhyNot, 'conditions' | 'trees'>): WhyNot['conditions'] {
	const isOpen = (ofSupervisor: boolean): boolean =>
		trees.some(({ about, tree }) => (about === 'supervisor') === ofSupervisor && tree.holds !== tree.wanted);
	const [model, supervisor] = [isOpen(false), isOpen(true)];
	return conditions.filter(({ kind }) => !(kind === 'written' ? model : kind === 'supervisor' && supervisor));
}
