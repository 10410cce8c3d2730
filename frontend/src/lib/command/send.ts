/**
 * Commands to the station: what a person asks for over REST.
 *
 * A command succeeds or is refused; a refusal carries words for the person. What a command did is never taken from its
 * answer: it shows in the stream.
 */
import type { Alarm, ApprovedAct, CorrectionPreview, Mode, OutOfService, Value, WayOffer, WhyNot } from '#lib/contract.ts';
import type { Refusal } from '#lib/rest/refusal.ts';
import { command, request, type Answer } from '#lib/rest/request.ts';

/** Milliseconds in which a plan that is asked for is found, or why there is none; the server waits no longer. */
const PLANNING = 20_000;

/** Changes the mode of execution. Restart mode has a way in and a way out of its own. */
export function setMode(mode: Exclude<Mode, 'restart'>): Promise<Refusal | null> {
	return command('PUT', '/api/v1/mode', { body: { mode } });
}

/** Has the station pause when the product that is in work is done, or go on as ever. */
export function setCycleStop(on: boolean): Promise<Refusal | null> {
	return command('PUT', '/api/v1/mode/cycle-stop', { body: { on } });
}

/** Has the station pause as soon as `condition` becomes true. 422: it cannot be read. */
export function setBreakpoint(condition: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/breakpoints', { body: { condition } });
}

/** Has the station pause for it no more. */
export function removeBreakpoint(id: string): Promise<Refusal | null> {
	return command('DELETE', `/api/v1/breakpoints/${encodeURIComponent(id)}`);
}

/** Allows outputs to be published. */
export function startProduction(): Promise<Refusal | null> {
	return command('POST', '/api/v1/production/start', { body: {} });
}

/** Has the operations wait for a restart. Nothing is started by it. */
export function enterRestart(reason?: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/restart/enter', { body: reason === undefined ? {} : { reason } });
}

/** Leaves restart mode for the paused one; to go on is another act. */
export function leaveRestart(): Promise<Refusal | null> {
	return command('POST', '/api/v1/restart/leave', { body: {} });
}

/** Has what was offered carried out, and nothing else. 409: the station has moved, and it has to be asked for again. */
export function takeOffer(offer: WayOffer, reason: string): Promise<Refusal | null> {
	const starts = (offer.errand?.steps ?? []).map((step) => step.ability);
	const corrections = Object.fromEntries(offer.corrections.map(({ name, then }) => [name, then]));
	return command('POST', '/api/v1/operator-plans', { body: { offer: offer.id, starts, corrections, reason } });
}

/** Finds a plan to where the operation begins. Nothing is changed by asking. */
export function findReset(operation: string): Promise<Answer<WayOffer>> {
	return request('POST', '/api/v1/operator-plans/reset-preview', { body: { operation }, patience: PLANNING });
}

/** Finds a plan to where `predicate` holds. 422: it cannot be read. Nothing is changed by asking. */
export function findGoal(predicate: string): Promise<Answer<WayOffer>> {
	return request('POST', '/api/v1/operator-plans/goal-preview', { body: { predicate }, patience: PLANNING });
}

/** Finds out why the operation is not active, or not done. */
export function whyNotOperation(operation: string): Promise<Answer<WhyNot>> {
	return request('GET', `/api/v1/operations/${encodeURIComponent(operation)}/blockers`, { patience: PLANNING });
}

/** Finds out why `predicate` does not hold. 422: it cannot be read. */
export function whyNotGoal(predicate: string): Promise<Answer<WhyNot>> {
	return request('POST', '/api/v1/goals/blockers', { body: { predicate }, patience: PLANNING });
}

/** Finds out what a correction would bring about. Nothing is changed by asking. */
export function previewCorrection(values: Readonly<Record<string, Value>>): Promise<Answer<CorrectionPreview>> {
	return request('POST', '/api/v1/corrections/preview', { body: { values }, patience: PLANNING });
}

/** Has the ability run once, alone. 409: its guard, the supervisor or the mode does not allow it, or devices are real. */
export function tryAbility(ability: string, realDevices: boolean, reason: string): Promise<Refusal | null> {
	const body = { ability, real_devices: realDevices, reason: reason === '' ? null : reason };
	return command('POST', '/api/v1/test-runs', { body });
}

/** Starts no further what is being carried out. */
export function stopErrand(): Promise<Refusal | null> {
	return command('POST', '/api/v1/operator-plans/stop', { body: {} });
}

/** Says that the alarm `key` has been seen as it was shown. 409: it has come again since. */
export function acknowledgeAlarm(key: string, alarm: Pick<Alarm, 'since'>): Promise<Refusal | null> {
	return command('POST', '/api/v1/alarms/acknowledge', { body: { alarm: key, since: alarm.since } });
}

/** Has nobody told of the alarm `key` for so many seconds. 409: it is too urgent, or gone. */
export function shelveAlarm(key: string, seconds: number, reason: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/alarms/shelve', { body: { alarm: key, seconds, reason } });
}

/** Has people told of a shelved alarm again. */
export function unshelveAlarm(key: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/alarms/unshelve', { body: { alarm: key } });
}

/** Takes the alarm `key` out of service. 409: it is too urgent, or gone. */
export function suppressAlarm(key: string, reason: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/alarms/suppress', { body: { alarm: key, reason } });
}

/** Puts an alarm back in service. */
export function restoreAlarm(key: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/alarms/restore', { body: { alarm: key } });
}

/** Takes out of service what is in it, until somebody puts it back. */
export function takeOut(of: string, name: string, reason: string): Promise<Refusal | null> {
	return setAvailability(of, name, { in_service: false, reason });
}

/** Puts back into service what was taken out of it. */
export function putBack({ of, name }: Pick<OutOfService, 'of' | 'name'>, reason: string): Promise<Refusal | null> {
	return setAvailability(of, name, { in_service: true, reason });
}

function setAvailability(of: string, name: string, body: { in_service: boolean; reason: string }): Promise<Refusal | null> {
	return command('PUT', `/api/v1/availability/${encodeURIComponent(of)}/${encodeURIComponent(name)}`, { body });
}

/** Decides which values outputs shall have that came back from the journal. */
export function decideOutputs(values: Readonly<Record<string, Value>>, reason: string): Promise<Refusal | null> {
	return command('PUT', '/api/v1/restored-outputs', { body: { values, reason } });
}

/** Says that the estimates are as believed. 409: one of them is another by now. */
export function confirmEstimates(values: Readonly<Record<string, Value>>, reason: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/corrections/confirm', { body: { values, reason } });
}

/** Gives estimates other values, all at once, as was looked at on `revision`. 409: the state is another by now. */
export function correctEstimates(
	values: Readonly<Record<string, Value>>,
	revision: number,
	reason: string
): Promise<Refusal | null> {
	return command('POST', '/api/v1/corrections', { body: { values, revision, reason } });
}

/** Takes back the correction that was made on `revision`. 409: it is not the last one any more. */
export function undoCorrection(revision: number, reason: string): Promise<Refusal | null> {
	return command('POST', '/api/v1/corrections/undo', { body: { revision, reason } });
}

/** Lets a measured variable or an output have a value for so many seconds. */
export function forceVariable(name: string, value: Value, seconds: number, reason: string): Promise<Refusal | null> {
	return command('PUT', `/api/v1/forces/${encodeURIComponent(name)}`, { body: { value, seconds, reason } });
}

const ASKED = { correction: 'corrections', outputs: 'restored-outputs', force: 'forces' } as const;

/** Asks a second person to approve what was looked at in the state of `revision`. */
export function askForApproval(act: ApprovedAct, revision: number, reason: string): Promise<Refusal | null> {
	return command('POST', `/api/v1/approvals/${ASKED[act.kind]}`, { body: { act, revision, reason } });
}

/** Approves what somebody else has asked for, as it was looked at in the state of `revision`: it is done at once. */
export function approveRequest(id: string, act: ApprovedAct, revision: number): Promise<Refusal | null> {
	return command('POST', `/api/v1/approvals/${encodeURIComponent(id)}/approve`, { body: { act, revision } });
}

/** Declines what somebody else has asked for, or withdraws what one has asked for oneself. */
export function declineRequest(id: string, act: ApprovedAct): Promise<Refusal | null> {
	return command('POST', `/api/v1/approvals/${encodeURIComponent(id)}/decline`, { body: { act } });
}

/** Lets a forced variable be as it comes. */
export function releaseForce(name: string): Promise<Refusal | null> {
	return command('DELETE', `/api/v1/forces/${encodeURIComponent(name)}`);
}

/** Takes control over from the session `over`, null when nobody is believed to hold it. 409: another holds it by now. */
export function takeControl(over: string | null, reason: string): Promise<Refusal | null> {
	const why = reason.trim();
	return command('PUT', '/api/v1/control-lock', { body: why === '' ? { over } : { over, reason: why } });
}

/** Gives control back: nobody holds it then. */
export function releaseControl(): Promise<Refusal | null> {
	return command('DELETE', '/api/v1/control-lock');
}
