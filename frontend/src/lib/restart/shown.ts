/** When a person has to do with a restart at all: as long as the station works by itself, the page does not speak of one. */
import { byUrgency, isNew, isOver, type Keyed } from '#lib/alarm/priority.ts';
import type { OutOfService, StationView, Value, Variable } from '#lib/contract.ts';
import { runs } from '#lib/resource/running.ts';
import { openQuestions } from './answers.ts';

/** Why a person is wanted for a restart, the most telling first. */
export type Wanted =
	| 'outside'
	| 'unsure'
	| 'undecided'
	| 'questions'
	| 'unconfirmed'
	| 'noPlan'
	| 'outOfService'
	| 'alarm'
	| 'errand'
	| 'restart'
	| 'hold'
	| 'paused';

/** Whether nothing is planned although something is to be done. */
export function lacksPlan(view: Pick<StationView, 'plan' | 'operations'>): boolean {
	return view.plan.status === 'none' && Object.values(view.operations).some((operation) => operation.active);
}

/** What is out of service of that with which operations are done. */
export function notUsed(view: StationView): OutOfService[] {
	return view.out_of_service.filter(({ of }) => of !== 'operation');
}

/** Whether the station may be safe, and what is awaited decides: nothing that is known says that it is not. */
export function isUnsure({ violated, differences, awaits }: NonNullable<StationView['way_back']>): boolean {
	return violated.length === 0 && differences.length === 0 && awaits.length > 0;
}

/** The alarms of what is not as it should be now; what only reminds people, such as of a force, is none of them. */
export function lastingAlarms({ alarms }: Pick<StationView, 'alarms'>): Keyed[] {
	return byUrgency(alarms).filter(([, alarm]) => alarm.ended === null && alarm.priority !== 'low');
}

/** The alarms of what has changed without a command, as where somebody moved it. */
export function movedByHand({ alarms }: Pick<StationView, 'alarms'>): Keyed[] {
	return byUrgency(alarms).filter(([, { kind, ended }]) => kind === 'by-hand' && ended === null);
}

/** Those of them at which nobody has looked: what is believed may be true no more. */
export function notLookedAt(view: Pick<StationView, 'alarms'>): Keyed[] {
	return movedByHand(view).filter(([, { by }]) => by === null);
}

/** The alarms of what did not go on and was called off by a Hold, which mends nothing: it does not run any more. */
export function haltedAlarms({ alarms, abilities, mode }: Pick<StationView, 'alarms' | 'abilities' | 'mode'>): Keyed[] {
	if (mode !== 'hold' && mode !== 'restart') return [];
	return byUrgency(alarms).filter(([, { kind, subject, ended }]) => {
		const ability = abilities[subject];
		return kind === 'overdue' && ended === null && ability !== undefined && !runs(ability);
	});
}

/** All reasons for which a person is wanted; none while the station works by itself. */
export function wantedFor(view: StationView): Wanted[] {
	const way = view.way_back;
	const reasons: [Wanted, boolean][] = [
		['outside', way !== null && !isUnsure(way)],
		['unsure', way !== null && isUnsure(way)],
		['undecided', Object.keys(view.undecided).length > 0],
		['questions', openQuestions(view).length > 0],
		['unconfirmed', view.unconfirmed],
		['noPlan', lacksPlan(view)],
		['outOfService', lacksPlan(view) && notUsed(view).length > 0],
		['alarm', lastingAlarms(view).length > 0],
		['errand', view.errand !== null],
		['restart', view.mode === 'restart'],
		['hold', view.mode === 'hold'],
		['paused', view.mode === 'paused']
	];
	return reasons.flatMap(([reason, holds]) => (holds ? [reason] : []));
}

/** The alarm that leads what is said of the station. Where a person is wanted it is one that lasts and not only reminds. */
export function leadingAlarm(view: StationView): Keyed | undefined {
	return (concernsRestart(view) ? lastingAlarms(view) : byUrgency(view.alarms))[0];
}

/** The alarms that are over and that nobody has seen, where what a person is wanted for leads and not an alarm. */
export function passedAlarms(view: StationView): Keyed[] {
	if (!concernsRestart(view) || leadingAlarm(view)) return [];
	return byUrgency(view.alarms).filter(([, alarm]) => isOver(alarm) && isNew(alarm));
}

/** Whether a person has asked for help with a task and nothing else is wanted: no way back helps with that. */
export function onlyHelps(view: StationView): boolean {
	return wantedFor(view).every((reason) => reason === 'alarm') && lastingAlarms(view).every(([, { kind }]) => kind === 'problem');
}

/** Whether there is anything to say of it. */
export function concernsRestart(view: StationView): boolean {
	return wantedFor(view).length > 0;
}

/** The estimates that nobody has confirmed since they came back from the journal. */
export function unconfirmed(variables: Readonly<Record<string, Variable>>): [string, Variable & { value: Value }][] {
	return Object.entries(variables).flatMap(([name, variable]) =>
		isUnconfirmed(variable) && variable.value !== null ? [[name, { ...variable, value: variable.value }]] : []
	);
}

/** Whether nobody has seen since that the value is still true. */
export function isUnconfirmed(variable: Variable): boolean {
	return (variable.belief?.unconfirmed_since ?? null) !== null;
}
