/** Findings as they are listed: the gravest first, or in groups of one kind, or of one file. */
import type { Finding, ModelCheck } from '#lib/contract.ts';
import { placeIn } from '#lib/model/address.ts';
import { isError } from '#lib/workshop/verdict.ts';

export type By = 'severity' | 'kind' | 'file';
export const WAYS: readonly By[] = ['severity', 'kind', 'file'];

export interface Listed {
	readonly finding: Finding;
	/** It stays the same while more is found, so that what is open stays open. */
	readonly key: string;
}

export interface Group {
	/** The severity, kind or file that they share. */
	readonly of: string;
	readonly listed: readonly Listed[];
}

/** The gravest kinds first; what is not named here comes after them. */
const GRAVE = [
	'unusable',
	'specification-cannot-be-met',
	'write-conflict',
	'goal-lost',
	'goal-out-of-reach',
	'never-allowed',
	'never-starts',
	'never-active'
];

export function groupsOf(findings: readonly Finding[], by: By): Group[] {
	const groups = new Map<string, Listed[]>();
	const seen = new Map<string, number>();
	for (const finding of findings) {
		const name = [finding.kind, placeOf(finding), finding.message].join('|');
		const nth = seen.get(name) ?? 0;
		seen.set(name, nth + 1);
		const of = finding[by];
		groups.set(of, [...(groups.get(of) ?? []), { finding, key: `${name}|${nth}` }]);
	}
	const found = [...groups].map(([of, listed]) => ({ of, listed }));
	return found.sort((one, other) => rank(one, by) - rank(other, by) || one.of.localeCompare(other.of));
}

/** What has errors comes first, and kinds by how grave they are. */
function rank({ of, listed }: Group, by: By): number {
	if (by !== 'kind') return listed.some(({ finding }) => isError(finding)) ? 0 : 1;
	const place = GRAVE.indexOf(of);
	return place < 0 ? GRAVE.length : place;
}

/** `resources/robot.yaml:12:3`. */
export function placeOf({ file, line, column }: Pick<Finding, 'file' | 'line' | 'column'>): string {
	return `${file}:${line}:${column}`;
}

/** Where the model, or that of an example, is shown at that place. */
export function addressOf({ file, line }: Pick<Finding, 'file' | 'line'>, example: string | null = null): string {
	return placeIn(example, { file, line });
}

export type RunAddress = `/api/v1/model/check/findings/${string}/run?${string}`;

/** Where the server tells of the run that shows a finding of this check, which may be that of an example. */
export function runOf({ number, findings }: Pick<ModelCheck, 'number' | 'findings'>, finding: Finding, example: string | null = null): RunAddress {
	const more = example === null ? '' : `&${new URLSearchParams({ example })}`;
	return `/api/v1/model/check/findings/${findings.indexOf(finding)}/run?number=${number}${more}`;
}
