/** What has not come to rest yet of what was started. */
import type { StationView } from '#lib/contract.ts';
import { runs } from '#lib/resource/running.ts';
import { resourceTitle } from './titles.ts';

/** The devices at which something runs, each once; what people do moves none. */
export function movingDevices(view: StationView): string[] {
	const running = Object.values(view.abilities).filter((ability) => runs(ability) && !ability.human);
	return [...new Set(running.map(({ resource }) => resourceTitle(view, resource)))];
}
