import type { Task } from '#lib/contract.ts';

export type Movers = Pick<Task, 'movers'>;

/** What moves once a task is done, each after who moves: `Robot: Move to the nutrunner, Lock the tool; Dock: Open`. Who may move is named alone. */
export const movesOf = ({ movers }: Movers): string => movers.map(({ title, moves }) => (moves.length > 0 ? `${title}: ${moves.join(', ')}` : title)).join('; ');
