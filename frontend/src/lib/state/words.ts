/** How variables, their values and their ages are said, in the language of the page. */
import type { StationView, Value } from '#lib/contract.ts';
import { say } from '#lib/text/text.svelte.ts';
import { valueText, variableName } from '#lib/wording/values.ts';

/** A value, or that it is not known. */
export function said(value: Value | null): string {
	if (value === null) return say().common.unknown;
	if (typeof value === 'boolean') return value ? say().common.yes : say().common.no;
	return valueText(value);
}

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

/** A variable as it is called where its resource is not in sight: `Robot · target pose`. */
export function fullName(view: Pick<StationView, 'resources' | 'variables'> | null, name: string): string {
	const resource = view?.variables[name]?.resource ?? null;
	const own = variableName(name, resource);
	return resource === null ? own : `${resourceTitle(view, resource)} · ${own}`;
}
