/** Where an ability of the station is looked at: in Model, at the part that it is an instance of. */
import { shownAt } from '#lib/examples/address.ts';

/** The address of the part of an ability, which shows that ability of all that the part stands for. */
export function addressOf(name: string): string {
	return shownAt('/model', null, { ability: name });
}
