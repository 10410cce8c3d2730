/** The steps of the page, and which of them the address asks for. */
export const STEPS = ['station', 'devices', 'poses', 'product', 'never', 'look'] as const;
export type Step = (typeof STEPS)[number];

export function stepAt(query: Pick<URLSearchParams, 'get'>): Step {
	const wanted = query.get('step');
	return STEPS.find((step) => step === wanted) ?? 'station';
}

export function addressOf(step: Step): string {
	return step === 'station' ? '/begin' : `/begin?step=${step}`;
}

/** The step before and the one behind; null where there is none. */
export function besides(step: Step): { readonly before: Step | null; readonly next: Step | null } {
	const at = STEPS.indexOf(step);
	return { before: STEPS[at - 1] ?? null, next: STEPS[at + 1] ?? null };
}
