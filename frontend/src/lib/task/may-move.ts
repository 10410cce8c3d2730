/** What moves for sure once a task is done, and what only may. */
import { movesOf, type Movers } from './moves.ts';

/** What moves, of those alone of which a plan says what they do. */
export const surelyOf = ({ movers }: Movers): string => movesOf({ movers: movers.filter(({ moves }) => moves.length > 0) });

/** Who may move as soon as it is done: there is no plan for that yet. */
export const mayMove = ({ movers }: Movers): string[] => movers.filter(({ moves }) => moves.length === 0).map(({ title }) => title);
