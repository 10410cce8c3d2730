/** A condition that is offered for a variable. */
import type { Variable } from '#lib/contract.ts';

/** That it becomes another value than it has now: `robot.pose == home`, `robot.moving`, `not robot.moving`. */
export function becoming(name: string, { value, domain }: Pick<Variable, 'value' | 'domain'>): string {
	const other = domain.find((each) => each !== value) ?? domain[0];
	if (typeof other === 'boolean') return other ? name : `not ${name}`;
	return other === undefined ? name : `${name} == ${String(other)}`;
}
