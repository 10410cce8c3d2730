/** What is told of the draft below its form: one at a time. */
export const PANELS = ['problems', 'usages', 'guards', 'runs', 'tests', 'changes', 'folds'] as const;
export type PanelName = (typeof PANELS)[number];

/** The one that an address asks for; null for none. */
export function panelIn(query: Pick<URLSearchParams, 'get'>): PanelName | null {
	return PANELS.find((each) => each === query.get('panel')) ?? null;
}
