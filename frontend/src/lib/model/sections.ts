/**
 * How the form of a part that has much to be said is divided: sections of which some are folded, so that all of it is in sight,
 * each with what is written in it.
 */
import { isMapping, titleAt, type Json } from './content.ts';
import { toldValue } from './types.ts';

export const SECTION_NAMES = ['what', 'person', 'start', 'course', 'finish'] as const;
export type FormSection = (typeof SECTION_NAMES)[number];
/** What of a form can be folded: its sections, and the conditions as they are in the station now. */
export type Fold = FormSection | 'now';

const SECTIONS: Readonly<Record<string, Readonly<Record<FormSection, readonly string[]>>>> = {
	ability: {
		what: ['title', 'parameters', 'duration', 'timeouts', 'late', 'restart', 'moves'],
		person: ['human', 'instruction'],
		start: ['enabled', 'start'],
		course: ['until', 'executing', 'finished'],
		finish: ['finish', 'cancel']
	}
};
/** Parts whose fields stand among those of their section, called by both names. */
export const FLAT: readonly string[] = ['timeouts', 'start', 'finish', 'cancel'];
/** Those that are called as their section is. */
const NAMED: readonly string[] = ['start', 'finish', 'human'];
/** Entries of fields that speak for themselves. */
const SPEAKS: readonly string[] = ['do', 'task', 'text', 'not_begun', 'not_finished'];
/** What is open at first. */
export const FIRST: readonly Fold[] = ['start'];

export const isDivided = (part: string): boolean => part in SECTIONS;

/** The sections of a part, and which of the fields `there` each has; those without any are left out. Null where it has none. */
export function sectionsOf(part: string, there: readonly string[]): readonly { readonly name: FormSection; readonly keys: readonly string[] }[] | null {
	const sections = SECTIONS[part];
	if (!sections) return null;
	return SECTION_NAMES.map((name) => ({ name, keys: sections[name].filter((key) => there.includes(key)) })).filter(({ keys }) => keys.length > 0);
}

/** What is written in the fields of a section, in a line. */
export function toldFields(
	written: readonly (readonly [key: string, value: Json | undefined])[],
	label: (key: string) => string,
	language: string
): string {
	return written
		.flatMap(([key, value]) => {
			if (value === undefined || value === null) return [];
			if (key === 'title') return titleAt(value, [], language) ?? toldValue(value);
			if (typeof value === 'boolean') return value ? label(key) : `${label(key)}: ${String(value)}`;
			if (key === 'duration' && Array.isArray(value)) return `${value.join(' – ')} s`;
			if (isMapping(value)) return `${NAMED.includes(key) ? '' : `${label(key)}: `}${Object.entries(value).map(([name, each]) => told(name, each, label, language)).join(', ')}`;
			return toldValue(value);
		})
		.map((text) => text.replace(/\s+/g, ' ').trim())
		.filter((text) => text !== '')
		.join(' · ');
}

/** One entry of a part: actions speak for themselves, texts by language are told in one. */
function told(name: string, value: Json, label: (key: string) => string, language: string): string {
	const text = (isMapping(value) ? titleAt(value, [], language) : null) ?? toldValue(value);
	return SPEAKS.includes(name) ? text : `${label(name)} ${text}`;
}
