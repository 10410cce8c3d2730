/** Which task the watch shows. */
import type { Task } from '#lib/contract.ts';

export interface Waiting {
	readonly id: string;
	readonly task: Task;
}

/** The tasks with the one that has waited longest first; of two created together, the one with the smaller id. */
export function inOrder(tasks: Readonly<Record<string, Task>>): Waiting[] {
	return Object.entries(tasks)
		.map(([id, task]) => ({ id, task }))
		.sort((a, b) => a.task.created - b.task.created || a.id.localeCompare(b.id, 'en', { numeric: true }));
}
