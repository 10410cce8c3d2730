/** Of what kind something is that happened, and how urgent. */
import type { Priority } from '#lib/contract.ts';
import type { Row } from './rows.ts';
import { partOf } from './told.ts';

export type EventKind = 'person' | 'watch' | 'key' | 'mode' | 'plan' | 'work' | 'hand' | 'alarm' | 'controller';

const MODE = new Set(['production-started', 'mode-changed', 'called-off', 'stepping-changed', 'step-taken', 'by-order-changed']);
const PLAN = new Set(['asked', 'answered', 'unanswered', 'explained', 'errand-taken', 'errand-stopped', 'jobs-sequenced']);
const HAND = new Set(['corrected', 'confirmed', 'forced', 'force-released', 'service-changed', 'by-hand']);
const CONTROLLER = new Set(['begun', 'snapshot', 'alarms-aside', 'beliefs', 'operations']);
const WORK = ['started', 'ended', 'activated', 'completed', 'called_off', 'given_up'];
const PRIORITIES: readonly unknown[] = ['high', 'medium', 'low'] satisfies Priority[];

/** Of what kind it is; an act is of who did it. */
export function kindOf(row: Row): EventKind {
	if (row.record === null) {
		const { kind } = row.act.record.entry.actor;
		return kind === 'watch' || kind === 'key' ? kind : 'person';
	}
	const { kind, content } = row.record;
	if (kind === 'alarm') return 'alarm';
	if (MODE.has(kind)) return 'mode';
	if (HAND.has(kind)) return 'hand';
	if (CONTROLLER.has(kind)) return 'controller';
	if (PLAN.has(kind)) return 'plan';
	return partOf(content, 'plan') !== null && !WORK.some((part) => part in content) ? 'plan' : 'work';
}

/** The priority of an alarm. */
export function priorityOf(row: Row): Priority | null {
	if (row.record?.kind !== 'alarm') return null;
	const { content } = row.record;
	const found = content['priority'] ?? partOf(content, 'what')?.['priority'];
	return PRIORITIES.includes(found) ? (found as Priority) : null;
}
