/**
 * What has to be done, one after the other, until the station is in the mode that is wanted. Each is a command of its own with a
 * record of its own; the first that is refused is the last that was sent.
 */
import { enterRestart, leaveRestart, setMode, startProduction, takeControl } from '#lib/command/send.ts';
import type { StationView } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';

export type ModeAct = 'control' | 'enter' | 'leave' | 'start' | 'go';
/** Control alone, restart mode, out of it without going on, production, or back in production as a whole. */
export type Aim = 'control' | 'enter' | 'leave' | 'start' | 'go' | 'production';

type Stands = Pick<StationView, 'mode' | 'production'>;

/** The acts to `aim`, for a person who is in control (`mine`) or not; none where it is so already. */
export function actsTo(aim: Aim, { mode, production }: Stands, mine: boolean): ModeAct[] {
	const whole = aim === 'production';
	const acts: [ModeAct, boolean][] = [
		['enter', aim === 'enter' && mode !== 'restart'],
		['leave', (whole || aim === 'leave') && mode === 'restart'],
		['start', (whole || aim === 'start') && production === 'waiting'],
		['go', (whole && mode !== 'automatic') || (aim === 'go' && (mode === 'paused' || mode === 'hold'))]
	];
	const wanted = acts.flatMap(([act, due]) => (due ? [act] : []));
	return !mine && (wanted.length > 0 || aim === 'control') ? ['control', ...wanted] : wanted;
}

const COMMAND: Record<ModeAct, () => Promise<Refusal | null>> = {
	control: () => takeControl(null, ''),
	enter: () => enterRestart(),
	leave: leaveRestart,
	start: startProduction,
	go: () => setMode('automatic')
};

/** Does one after the other, telling of each that is done; why one was refused, after which nothing more is sent. */
export async function doAll(
	acts: readonly ModeAct[],
	ondone: (act: ModeAct) => void,
	commands: typeof COMMAND = COMMAND
): Promise<Refusal | null> {
	for (const act of acts) {
		const refusal = await commands[act]();
		if (refusal !== null) return refusal;
		ondone(act);
	}
	return null;
}
