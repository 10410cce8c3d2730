import type { Task } from '#lib/contract.ts';

type Movers = Pick<Task, 'movers'>;

/** What moves once a task is done, each after who moves: `Robot: Move to the nutrunner, Lock the tool; Dock: Open`. Who may move is named alone. */
export const movesOf = ({ movers }: Movers): string => movers.map(({ title, moves }) => (moves.length > 0 ? `${title}: ${moves.join(', ')}` : title)).join('; ');

/** The same of those alone of which a plan says what they do. */
export const surelyOf = ({ movers }: Movers): string => movesOf({ movers: movers.filter(({ moves }) => moves.length > 0) });

/** Who may move as soon as it is done: there is no plan for that yet. */
export const mayMove = ({ movers }: Movers): string[] => movers.filter(({ moves }) => moves.length === 0).map(({ title }) => title);
