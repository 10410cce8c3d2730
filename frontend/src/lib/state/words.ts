/** How the ages of values and their resources are said, in the language of the page. */
import type { StationView } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';
import { fullName, valueOf } from '#lib/wording/names.svelte.ts';

/** A span of time in the coarsest unit that says enough. Clocks that disagree by a moment give none. */
export function spanOf(seconds: number): readonly [number, 's' | 'min' | 'h' | 'days'] {
	const whole = Math.max(0, Math.floor(seconds));
	if (whole < 120) return [whole, 's'];
	if (whole < 7200) return [Math.floor(whole / 60), 'min'];
	if (whole < 172800) return [Math.floor(whole / 3600), 'h'];
	return [Math.floor(whole / 86400), 'days'];
}

/** How long ago something was: `12 s ago`; told from an old view, `12 s before`. */
export function agoWords(seconds: number, live: boolean): string {
	const [n, unit] = spanOf(seconds);
	const texts = say().state;
	if (live && n === 0) return texts.justNow;
	const span = `${n} ${texts.units[unit]}`;
	return live ? texts.ago(span) : texts.before(span);
}

/** What a resource is called; what belongs to none belongs to the product. */
export function resourceTitle(view: Pick<StationView, 'resources'> | null, resource: string | null): string {
	return resource === null ? say().state.product : (view?.resources[resource]?.title ?? resource);
}

/** A span of time: `19 s`, `5 min`. */
export function spanWords(seconds: number): string {
	const [n, unit] = spanOf(seconds);
	return `${n} ${say().state.units[unit]}`;
}

/** Who wrote a value: an ability by its title, what only a program is called in words, a person as they are called. */
export function writerText(view: Pick<StationView, 'abilities'> | null, writer: string): string {
	const words = say().state.writers;
	if (writer === 'the model' || writer === 'the journal') return words[writer];
	const job = /^job (.+)$/.exec(writer)?.[1];
	return job === undefined ? (view?.abilities[writer]?.title ?? writer) : words.job(job);
}

/** Since when somebody or something has it that a value is so, `at` a time of the clock. */
export function sinceText(view: Pick<StationView, 'abilities'> | null, writer: string, at: string): string {
	const texts = say().state.correct.since;
	const said = writerText(view, writer);
	if (view?.abilities[writer]) return texts.ability(said, at);
	return said === writer && !writer.startsWith('job ') ? texts.person(said, at) : texts.program(said, at);
}

/** What was measured, as it stands in a belief: `robot.pose == home`, `robot.moving` or `not robot.moving`. */
const MEASURED = /^(not )?([^\s=]+)(?: == (.+))?$/;

/** The same with the names that variables and values have for people: `Pose of the robot: home`. */
export function evidenceText(view: Pick<StationView, 'resources' | 'variables'> | null, written: string): string {
	const [, not, name, value] = MEASURED.exec(written) ?? [];
	if (name === undefined) return written;
	const said = value ?? not === undefined;
	return `${fullName(view, name)}: ${valueOf(name, said)}`;
}
