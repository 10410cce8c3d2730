/** Which of the documents is shown beside a step. */
import { STATION } from '#lib/model/tree.ts';
import type { Sketch } from './sketch.ts';
import type { Step } from './steps.ts';

/** The document that a step writes, of the device that is looked at where that has one of its own. */
export function fileOf(step: Step, sketch: Sketch, device: number | null): string {
	switch (step) {
		case 'devices':
		case 'poses': {
			const among = step === 'poses' ? sketch.devices.filter(({ kind }) => kind === 'robot') : sketch.devices;
			const found = among.find(({ id }) => id === device) ?? among[0];
			return found ? `resources/${found.name}.yaml` : STATION;
		}
		case 'product':
			return 'operations.yaml';
		case 'never':
			return 'specifications.yaml';
		default:
			return STATION;
	}
}
