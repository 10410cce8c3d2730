import type { Task } from '#lib/contract.ts';

/** What moves once a task is done, each after who moves: `Robot: Move to the nutrunner, Lock the tool; Dock: Open`. */
export const movesOf = (task: Task): string => task.movers.map(({ title, moves }) => `${title}: ${moves.join(', ')}`).join('; ');
