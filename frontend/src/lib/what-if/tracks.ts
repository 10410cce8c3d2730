/** What ran in which steps, as lanes with one column for each moment. */
import type { StepMoment } from '#lib/contract.ts';

/** A run of an ability, from the column of its start to that of its end. */
export interface Bar {
	readonly ability: string;
	readonly from: number;
	readonly to: number;
	/** It has not ended by the last moment. */
	readonly open: boolean;
}

export interface Track {
	readonly resource: string;
	readonly bars: readonly Bar[];
	/** The columns in which somebody, a device or a fault did something without a run of an ability. */
	readonly marks: readonly number[];
}

/** The lanes of some moments; `resourceOf` says whose an ability is. */
export function tracksOf(moments: readonly StepMoment[], resourceOf: (ability: string) => string): Track[] {
	const bars = new Map<string, Bar[]>();
	const open = new Map<string, number>();
	const lane = (resource: string): Bar[] => {
		const found = bars.get(resource) ?? [];
		bars.set(resource, found);
		return found;
	};
	const close = (ability: string, to: number, isOpen: boolean): void => {
		lane(resourceOf(ability)).push({ ability, from: open.get(ability) ?? to, to, open: isOpen });
		open.delete(ability);
	};
	moments.forEach((moment, column) => {
		for (const ability of moment.ended) if (open.has(ability)) close(ability, column, false);
		for (const ability of [...moment.step.starts, ...moment.running]) if (!open.has(ability)) open.set(ability, column);
		// One that is over as it starts never runs.
		for (const ability of moment.step.starts) if (!moment.running.includes(ability) && isOver(moments, column, ability)) close(ability, column, false);
	});
	for (const ability of [...open.keys()]) close(ability, moments.length - 1, true);
	const marks = new Map<string, number[]>();
	moments.forEach(({ resource, step }, column) => {
		if (column === 0 || resource === null || step.starts.length > 0) return;
		lane(resource);
		marks.set(resource, [...(marks.get(resource) ?? []), column]);
	});
	return [...bars].map(([resource, found]) => ({ resource, bars: found, marks: marks.get(resource) ?? [] }));
}

/** Whether a run that began in a column is never seen afterwards. */
function isOver(moments: readonly StepMoment[], column: number, ability: string): boolean {
	for (const moment of moments.slice(column + 1)) {
		if (moment.step.starts.includes(ability)) return true;
		if (moment.running.includes(ability) || moment.ended.includes(ability)) return false;
	}
	return false;
}
