/** What led here, in a few words. */
import type { LastCorrection } from '#lib/contract.ts';
import { valueText, variableName } from '#lib/wording/values.ts';

/** What was said of the station: `bolts · bolt pair 1 = placed`. */
export function correctedText({ values }: Pick<LastCorrection, 'values'>): string {
	return Object.entries(values)
		.map(([name, value]) => `${variableName(name, null)} = ${valueText(value)}`)
		.join(', ');
}
