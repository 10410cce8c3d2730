/**
 * The fields of a part that its form always shows. The others are shown where something is written in them, and else behind
 * *More*: most of what can be said of a part is said of few.
 */
const PRIMARY: Readonly<Record<string, readonly string[]>> = {
	ability: ['title', 'enabled', 'start', 'until', 'executing', 'finish', 'duration'],
	alarm: ['when', 'title', 'priority'],
	effect: ['kind', 'when', 'do', 'takes'],
	cancel: ['do'],
	finish: ['do'],
	operation: ['title', 'precondition', 'goal'],
	sequence: ['title', 'sequence'],
	service: ['type', 'when'],
	start: ['do'],
	station: ['name', 'title', 'description', 'rest'],
	timeouts: ['react', 'finish'],
	topic: ['type', 'direction', 'deadline', 'every'],
	variable: ['type', 'initial', 'title'],
	work_master: ['title', 'sequence', 'brings']
};

/** Whether a field is shown even if nothing is written in it. */
export function isPrimary(part: string, key: string): boolean {
	return PRIMARY[part]?.includes(key) ?? true;
}
