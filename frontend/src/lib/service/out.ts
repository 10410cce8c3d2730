/** What takes part in the work. */
import type { OutOfService } from '#lib/contract.ts';

/** Since when, because of whom and why `name`, a resource, an ability or an operation as `of` says, is out of service. */
export function outOf(all: readonly OutOfService[], of: OutOfService['of'], name: string): OutOfService | null {
	return all.find((each) => each.of === of && each.name === name) ?? null;
}
