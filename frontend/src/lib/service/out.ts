/** What takes part in the work. */
import type { OutOfService } from '#lib/contract.ts';

/** Whether `name`, a resource, an ability or an operation as `of` says, is out of service. */
export function isOut(all: readonly OutOfService[], of: OutOfService['of'], name: string): boolean {
	return all.some((each) => each.of === of && each.name === name);
}
