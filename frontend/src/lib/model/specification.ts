/** The kinds of specifications: each says what must never be with keys of its own. */
import type { Json } from './content.ts';

export type SpecificationKind = 'forbidden' | 'never' | 'exclusive' | 'zone' | 'order';

/** What each begins as: it forbids nothing yet. */
export const SPECIFICATIONS: Readonly<Record<SpecificationKind, Readonly<Record<string, Json>>>> = {
	forbidden: { forbidden: false },
	never: { never: false, while: false },
	exclusive: { exclusive: [] },
	zone: { zone: {} },
	order: { order: [] }
};

/** The keys that a specification has no field for, as it is of another kind; none while its kind is open. */
export function keysOfOthers(there: (key: string) => boolean): string[] {
	const [own, others] = [true, false].map((is) =>
		Object.values(SPECIFICATIONS).filter((kind) => Object.keys(kind).some(there) === is)
	);
	return own?.length ? (others ?? []).flatMap((kind) => Object.keys(kind)) : [];
}
