"""English texts of why something is not done: of each kind a title, and in which way with what to do about it."""

from __future__ import annotations

from typing import Final

REFUSALS: Final[dict[str, str]] = {
    # Commands of people: what keeps the station from doing them.
    "refused.alarm-set-aside": "The alarm is put aside",
    "refused.alarm-set-aside.state": "It is {state}, so nobody has to acknowledge it.",
    "refused.alarm-set-aside.out-of-service": "It is out of service: an engineer can restore it.",
    "refused.alarm-recurred": "The alarm has come again",
    "refused.alarm-recurred.look": "Look at it, then acknowledge this one.",
    "refused.alarm-not-shelved": "The alarm is not shelved",
    "refused.alarm-not-shelved.state": "It is {state}: nothing has to be done.",
    "refused.alarm-in-service": "The alarm is in service",
    "refused.alarm-in-service.state": "It is {state}: nothing has to be done.",
    "refused.alarm-gone": "The alarm is gone",
    "refused.alarm-gone.look": "Look at the alarms that there are now.",
    "refused.alarm-too-urgent": "The alarm is too urgent to be put aside",
    "refused.alarm-too-urgent.high": (
        "One of high priority can be acknowledged, but is told as long as its cause lasts."
    ),
    "refused.not-recorded": "The command cannot be recorded",
    "refused.not-recorded.journal": (
        "What cannot be recorded is not done. See the alarms for the cause; pausing is possible."
    ),
    "refused.command-overtaken": "The station was paused meanwhile",
    "refused.command-overtaken.paused": (
        "Somebody paused the station before this could be carried out. Look at the station, then try again."
    ),
    "refused.stop-not-recorded": "The station is stopped, and it is not written down",
    "refused.stop-not-recorded.nowhere": (
        "It was carried out, but neither the journal nor the file beside it could be written: a controller that "
        "begins anew would not know of it. Stay at the station, and make room for its database and for {path}."
    ),
    "refused.real-devices": "There are real devices",
    "refused.real-devices.demonstration": "{devices}. A demonstration may command emulated devices only.",
    "refused.real-devices.confirm": "{devices}. Confirm that real devices may move.",
    # Two people, and who is in control.
    "refused.approval-needed": "A second person is needed",
    "refused.approval-needed.ask": "A second person has to approve what is done to {variables}: ask for that.",
    "refused.no-approval-needed": "Nobody has to approve it",
    "refused.no-approval-needed.free": "None of these variables asks for a second person: it can be done at once.",
    "refused.same-person": "A second person is needed",
    "refused.same-person.yourself": "You have asked for it yourself: somebody else has to approve it.",
    "refused.same-person.saved": "You have saved “{name}” yourself: somebody else has to look at it.",
    "refused.not-approved": "Nobody else has approved it",
    "refused.not-approved.nobody": (
        "What is deployed here is approved by a second person. Somebody else than who saved “{name}” has to approve it."
    ),
    "refused.not-approved.alone": (
        "You alone have approved “{name}”, and nobody of this station has saved it. Somebody else has to approve it."
    ),
    "refused.not-approved.changes": (
        "{people} asked for changes in “{name}”. "
        "Save another revision with them, or {people} approves this one after all."
    ),
    "refused.no-review": "There is nothing to withdraw",
    "refused.no-review.withdraw": "You have said nothing of “{name}” that still counts.",
    "refused.request-gone": "The request is gone",
    "refused.request-gone.gone": (
        "Nobody waits for this any more: it was answered, took too long, or the state has moved. Ask anew."
    ),
    "refused.not-confirmed": "Something else was confirmed",
    "refused.not-confirmed.request": (
        "What was answered is not what the request asks for. Look at it again, then answer that."
    ),
    "refused.not-confirmed.offer": (
        "What was confirmed is not what the offer contains. Look at the offer again, then confirm that."
    ),
    "refused.not-a-person": "Two people are needed",
    "refused.not-a-person.demonstration": (
        "It takes two people who have signed in, each by their own name; a demonstration is nobody."
    ),
    "refused.stale-revision": "The state has moved",
    "refused.stale-revision.looked": (
        "Something has changed at the station since this was looked at. Look at it again, then decide."
    ),
    "refused.stale-revision.offered": (
        "Something has changed at the station since this was offered. Ask again what there is to do now."
    ),
    "refused.stale-revision.other": "The last correction is another one by now, made by {by}. Look at it, then decide.",
    "refused.stale-revision.value": (
        "Something that was corrected has got another value since. Look at the state and correct that."
    ),
    "refused.no-session": "Control is for people",
    "refused.no-session.person": "Only a person who is signed in can take control; a key or a watch cannot.",
    "refused.control-changed": "Somebody else is in control",
    "refused.control-changed.holder": "{holder} has control by now. Speak to them, then take it over from them.",
    "refused.control-needed": "Control is needed",
    "refused.control-needed.nobody": "Nobody is in control. Take control, then try again.",
    "refused.control-needed.holder": (
        "{holder} is in control. Only who is in control can do this; take it over if you must."
    ),
    "refused.control-needed.goes-on": "Only who is in control lets devices go on. Take control, then try again.",
    # Forces and corrections.
    "refused.not-forceable": "It cannot be forced",
    "refused.not-forceable.kind": "`{name}` is {kind}, and only measured variables and outputs can be forced.",
    "refused.not-forceable.correct": (
        "`{name}` is {kind}, and only measured variables and outputs can be forced. If it is not true, correct it "
        "instead."
    ),
    "refused.not-in-domain": "No such value",
    "refused.not-in-domain.none": "`{name}` is one of {domain}, and {value} is none of these.",
    "refused.unknown-variable": "There is no such variable",
    "refused.unknown-variable.name": "The station has no variable `{name}`{hint}",
    "refused.force-unsafe": "That is not safe",
    "refused.force-unsafe.violates": "It would violate {specifications}. Nothing was forced.",
    "refused.force-unsafe.outside": (
        "The station is outside its safe states, and would be so with it too. Nothing was forced."
    ),
    "refused.force-unsafe.forbidden": (
        "From there a device could bring about what is forbidden, or rest could no longer be reached. Nothing was "
        "forced."
    ),
    "refused.nothing-to-undo": "There is nothing to undo",
    "refused.nothing-to-undo.none": (
        "There is no correction that could be taken back: correct what is not true once more."
    ),
    "refused.nothing-to-confirm": "There is nothing to decide",
    "refused.nothing-to-confirm.names": "Nobody has to decide on {names}.",
    "refused.output-unsafe": "That is not safe",
    "refused.output-unsafe.outside": (
        "With these values the station would be outside its safe states. Choose others, or several at once."
    ),
    "refused.not-estimated": "It is not estimated",
    "refused.not-estimated.kind": (
        "`{name}` is {kind}; only what is estimated can be corrected, as nothing else says what it is."
    ),
    "refused.not-an-output": "It is no output",
    "refused.not-an-output.kind": "`{name}` is {kind}, and no output.",
    # Modes and production.
    "refused.not-in-restart": "The station is not in restart mode",
    "refused.not-in-restart.leave": "The mode is {mode}: there is nothing to leave.",
    "refused.not-in-restart.correct": (
        "Corrections are made in restart mode, or before production is started. Enter restart mode first."
    ),
    "refused.plan-running": "Something else is being carried out",
    "refused.plan-running.title": "{title} is being carried out. Wait for its end, or stop it.",
    "refused.too-many-breakpoints": "There are too many breakpoints",
    "refused.too-many-breakpoints.most": "There are {most}. Remove one first.",
    "refused.no-breakpoint": "There is no such breakpoint",
    "refused.no-breakpoint.gone": "It was removed, or the controller has begun anew.",
    "refused.not-automatic": "The station is not in automatic mode",
    "refused.not-automatic.now": "The mode is {mode}: there is nothing to pause later.",
    "refused.no-product-end": "The model does not tell when a product is done",
    "refused.no-product-end.pause": "No operation of a work master comes after all others. Pause the station now.",
    "refused.not-stepping": "The station is not stepping",
    "refused.not-stepping.starts": "Starts do not wait for steps. Switch stepping on first.",
    "refused.production-started": "Production is started",
    "refused.production-started.already": "Production has been started already.",
    "refused.production-started.outputs": (
        "Production has been started, so outputs are what abilities write. An engineer can force one."
    ),
    "refused.production-not-started": "Production waits",
    "refused.production-not-started.offer": (
        "Production has not been started, so nothing can be. Start production, then ask again."
    ),
    "refused.production-not-started.try": (
        "No command is sent before production is started. Pause, then start production, then try it."
    ),
    "refused.other-controller": "Somebody else commands the devices",
    "refused.other-controller.rivals": "{rivals}. Stop the other one.",
    "refused.other-controller.waits": "{who}.",
    "refused.outputs-unconfirmed": "It is not decided what devices shall do",
    "refused.outputs-unconfirmed.named": (
        "Devices would move as soon as it is published what {names} said before. Decide on each first."
    ),
    "refused.in-automatic": "The station is at work",
    "refused.in-automatic.pause": "Operations are executed automatically. Pause the station first.",
    "refused.in-restart": "The station is in restart mode",
    "refused.in-restart.leave": "Leave restart mode first; to go on is another decision.",
    "refused.outside-safe-states": "The station is outside its safe states",
    "refused.outside-safe-states.ways": "{situation} Enter restart mode and see which ways lead back.",
    "refused.unknown-name": "There is no such thing",
    "refused.unknown-name.resource": "The station has no resource `{name}`. Look at what it has.",
    "refused.unknown-name.ability": "The station has no ability `{name}`. Look at what it has.",
    "refused.unknown-name.operation": "The station has no operation `{name}`. Look at what it has.",
    "refused.wrong-mode": "The mode is another one",
    "refused.wrong-mode.restart": "The mode is {mode}, and this takes restart mode. Enter it, then ask again.",
    "refused.wrong-mode.paused": (
        "The mode is {mode}, and this takes the paused mode, or restart. Pause, then ask again."
    ),
    "refused.wrong-mode.try": "The mode is {mode}: an ability is tried while the station is paused. Pause it first.",
    # Ways on, trials and questions.
    "refused.manual-step-required": "Something has to be done first",
    "refused.manual-step-required.station": "Something has to be done at the station first. Do that, then ask again.",
    "refused.nothing-to-execute": "There is nothing to take",
    "refused.nothing-to-execute.restart": (
        "Nothing has to be carried out. Leave restart mode if the station is in it, and go on."
    ),
    "refused.proposal-gone": "The offer is gone",
    "refused.proposal-gone.ask": "Ask again what there is to do now.",
    "refused.goal-holds": "The goal holds already",
    "refused.goal-holds.nothing": "It holds already: nothing has to be done for it.",
    "refused.no-plan": "There is no plan",
    "refused.no-plan.because": "There is no plan as long as all of this is so: {because}.",
    "refused.no-plan.proven": "There is no plan at all from the present state: that is proven.",
    "refused.no-plan.not-found": "No plan was found in the time there is; that there is none is not proven. Try again.",
    "refused.unknown-operation": "There is no such operation",
    "refused.unknown-operation.those": "The station has no operation `{name}`. Look at those it has.",
    "refused.unknown-ability": "There is no such ability",
    "refused.unknown-ability.those": "The station has no ability `{name}`. Look at those it has.",
    "refused.not-startable": "It may not start now",
    "refused.not-startable.waits": "“{ability}” waits for {conditions}.",
    "refused.bad-predicate": "The predicate cannot be read",
    "refused.bad-predicate.constant": "It names no variable, so it never becomes true.",
    "refused.bad-predicate.at": "character {character}: {why}",
    "refused.bad-predicate.text": "character {character}, `{text}`: {why}",
    "refused.advisor-timeout": "The advisor was too slow",
    "refused.advisor-timeout.again": "No answer was found in time; nothing was changed by asking. Try again.",
    "refused.advisor-unavailable": "The advisor cannot answer",
    "refused.advisor-unavailable.again": "{why^}. Nothing was changed by asking; try again in a moment.",
    # Jobs and their orders.
    "refused.unknown-work-master": "There is no such work master",
    "refused.unknown-work-master.name": "The station has no work master `{name}`{hint}",
    "refused.unknown-work-master.known": "The station has no work master `{name}`. It has: {known}.",
    "refused.unknown-work-master.none": "The station has no work master `{name}`. It has: none.",
    "refused.job-conflict": "Another job is in the way",
    "refused.job-conflict.id": "Job {job} is one of the work master {master}. Give the new one another id.",
    "refused.job-conflict.common": "Job {job} ({title}) is under way and has {operations} too. Wait for its end.",
    "refused.not-in-job-mode": "The station works freely",
    "refused.not-in-job-mode.by-order": (
        "Its operations become active whenever they can. A person has to let it work by order first."
    ),
    "refused.cyclic-order": "The order leads into a circle",
    "refused.cyclic-order.circle": "Each of these would have to be completed before the next: {circle}.",
    "refused.job-under-way": "The job has not ended",
    "refused.job-under-way.state": "Job {job} ({title}) is {state}. Abort it, or wait for its end.",
    "refused.jobs-under-way": "Jobs are under way",
    "refused.jobs-under-way.named": "Jobs are under way: {jobs}. Wait for their end, or stop or abort them.",
    "refused.unknown-job": "There is no such job",
    "refused.unknown-job.name": "The station has no job `{name}`. Look at what it has.",
    "refused.job-ended": "The job has ended",
    "refused.job-ended.nothing-left": "Job {job} ({title}) is {state}. There is nothing left of it to end.",
    "refused.job-ended.order-another": "Job {job} ({title}) is {state}. Order another one.",
    "refused.job-order-exists": "There is such a job order",
    "refused.job-order-exists.id": "There is a job order {id} already, or there was. Every order has an id of its own.",
    "refused.too-many-job-orders": "There are too many job orders",
    "refused.too-many-job-orders.most": "The station holds {most} orders that are not over. Try again when some are.",
    "refused.job-order-changed": "The job order has changed",
    "refused.job-order-changed.revision": (
        "Somebody or the station has changed it since: it has the revision {revision}. Read it again."
    ),
    "refused.job-order-started": "The job order has started",
    "refused.job-order-started.state": (
        "It is {state}, and an order can be changed until the station works on it. Store another one instead."
    ),
    "refused.command-not-allowed": "The command is not allowed",
    "refused.command-not-allowed.allows": "The order is {state}: it allows {allowed}.",
    "refused.command-not-allowed.allows-wish": (
        "The order is {state}, and the station is to {wish} it: it allows {allowed}."
    ),
    "refused.no-job-order": "There is no such job order",
    "refused.no-job-order.id": "There is no job order with this id. Look at those that there are.",
    "refused.job-order-gone": "The job order is kept no more",
    "refused.job-order-gone.ended": (
        "It was over at {time}, and is kept no more: whoever administers the station finds it in its archive."
    ),
    "refused.events-gone": "These events are kept no more",
    "refused.events-gone.up-to": (
        "The events up to {number} are kept no more: whoever administers the station finds them in its archive. "
        "Read the orders and their responses anew, and the events after {number}."
    ),
    "refused.event-not-known": "There is no such event yet",
    "refused.event-not-known.newest": (
        "There is no event {number}, the newest is {last}: the station was restored from a backup. Read the orders "
        "anew, and the events after {last}."
    ),
    "refused.responses-gone": "These responses are kept no more",
    "refused.responses-gone.up-to": (
        "The responses up to {number} are kept no more: whoever administers the station finds them in its archive. "
        "Read those after {number}."
    ),
    "refused.no-job-response": "There is no such response",
    "refused.no-job-response.id": "There is no job order with this id that is over: a response is written when it is.",
    "refused.idempotency-key-reused": "The key belongs to another request",
    "refused.idempotency-key-reused.other": (
        "Another request had the same Idempotency-Key. A key belongs to one request and its repetitions."
    ),
    "refused.too-many-webhooks": "There are too many webhooks",
    "refused.too-many-webhooks.most": "There are {most} webhooks. Delete one that is not needed.",
    "refused.no-webhook": "No such webhook",
    "refused.no-webhook.id": "There is no webhook with this id. Look at those that there are.",
    "refused.webhook-target-refused": "The URL is not sent to",
    "refused.webhook-target-refused.why": "Nothing is sent to this URL: {why}.",
    # Overrides, records and deployments.
    "refused.out-of-bounds": "The value is not allowed",
    "refused.out-of-bounds.why": "{name}: {why}.",
    "refused.no-override": "There is no such override",
    "refused.no-override.name": "There is no `{name}`{hint}",
    "refused.no-pipeline": "There is no such pipeline",
    "refused.no-pipeline.name": "What runs has no `{name}`.",
    "refused.record-too-large": "The record is too large",
    "refused.record-too-large.why": "The last record of `{pipeline}` is too large to be told: {why}.",
    "refused.no-record": "There is no such record",
    "refused.no-record.pipeline": (
        "Nothing has passed `{pipeline}` since the controller began. Try again when something has."
    ),
    "refused.no-record.empty": "Nothing has happened yet: the journal is empty.",
    "refused.model-unusable": "The model cannot be used",
    "refused.model-unusable.why": "{why}.",
    "refused.no-supervisor": "The specifications cannot be met",
    "refused.no-supervisor.why": "{why}.",
    "refused.safety-unknown": "It is not known what is safe",
    "refused.not-emulated": "There are real devices",
    "refused.not-emulated.reset": (
        "Only emulated devices can begin anew as the model says. Deploy without resetting the simulation."
    ),
    "refused.not-staged": "The files are not there",
    "refused.not-staged.again": "Try once more to deploy the revision.",
    "refused.model-not-written": "The model cannot be written",
    "refused.model-not-written.why": (
        "The files of the model cannot be written: {why}. Look at who may write to its folder."
    ),
    "refused.deployment-under-way": "Another model is being started",
    "refused.deployment-under-way.by": (
        "{by} has deployed {name}, and the station begins anew with it. Nothing is published until it runs and "
        "somebody starts production. Try again then."
    ),
    "refused.not-paused": "The station did not pause when the product was done",
    "refused.not-paused.taken-back": (
        "The pause was taken back, or the station was paused or held before. Plan the deployment again, or deploy now."
    ),
    "refused.not-the-draft": "The draft is not this revision",
    "refused.not-the-draft.take-back": (
        "What is deployed is the draft, once it was saved: take the revision back into the draft first."
    ),
    "refused.not-legal": "The station cannot take it now",
    "refused.not-legal.obstacle": "{why}.",
    "refused.not-legal.under-way": (
        "{abilities}: this still runs, and is another one in the new model. Wait until it has finished."
    ),
    "refused.not-legal.violates": (
        "In its present state the station would be outside the safe states of this model. It would violate: "
        "{specifications}."
    ),
    "refused.not-legal.no-rest": (
        "In its present state the station would be outside the safe states of this model. From there nothing could "
        "come to rest."
    ),
    "refused.stale-draft": "The draft has changed",
    "refused.stale-draft.look": (
        "Somebody has changed the draft since you looked at it. Look at it again, then repeat this."
    ),
    "refused.no-simulation": "There is no such simulation any more",
    "refused.recording-unread": "The recording cannot be used",
    "refused.recording-too-large": "The recording is too large",
    "refused.recording-too-large.most": (
        "It has more than {most} MB. Record fewer topics or a shorter time, or start the station with a larger "
        "`--largest-recording`."
    ),
    "refused.not-octets": "The body is not a file",
    "refused.not-octets.header": "Send the file as it is, with the header `Content-Type: application/octet-stream`.",
    "refused.recording-incomplete": "The recording did not come whole",
    "refused.recording-incomplete.again": "Its end did not arrive. Send it again.",
    "refused.no-recording": "There is no such recording any more",
    "refused.no-recording.again": (
        "The station keeps the last {most} recordings, each for {minutes} minutes after it was used. Choose the file "
        "again."
    ),
    "refused.no-room": "There is no room for it",
    "refused.no-room.disk": "The disk of the station has no room for the recording: {why}. Make room there.",
    "refused.not-simulated": "That cannot be simulated",
    "refused.not-folded": "The state space cannot be shown like that",
    "refused.no-revision": "There is no such revision",
    "refused.no-revision.look": "Look at the revisions that there are.",
    "refused.no-example": "There is no such example",
    "refused.no-example.look": "There is no example station “{name}”. Look at those that there are.",
    "refused.example-unchanged": "An example is only looked at",
    "refused.example-unchanged.begin": (
        "This cannot be done with an example station. Begin with it: then it is your own draft."
    ),
    # The draft, what is kept, backups and the past.
    "refused.no-model": "The model is not known",
    "refused.no-model.start": (
        "This server does not know where the station's model is. Start it with `sequence-planner run MODEL`."
    ),
    "refused.no-run": "There is no such run",
    "refused.part-changed": "It was changed meanwhile",
    "refused.part-changed.why": (
        "{why^}. Nothing was changed: look at what it is now, and repeat yours if it is still wanted."
    ),
    "refused.edit-refused": "It cannot be changed so",
    "refused.edit-refused.why": "{why^}.",
    "refused.attach-refused": "The topic cannot be attached",
    "refused.attach-timeout": "The topic was not attached in time",
    "refused.attach-timeout.given-up": (
        "It took more than {seconds} s and was given up. Look at the model before trying again."
    ),
    "refused.demonstration": "A demonstration keeps nothing",
    "refused.demonstration.backups": (
        "What a demonstration keeps is forgotten at its end, so there is nothing to back up."
    ),
    "refused.demonstration.archive": "What a demonstration keeps is forgotten at its end, so nothing is archived.",
    "refused.no-backup": "The backup is not there",
    "refused.no-backup.folder": "There is no backup of this name in {folder}. Look at the list again.",
    "refused.backup-refused": "A backup cannot be made",
    "refused.backup-busy": "Another backup is worked on",
    "refused.backup-busy.by": (
        "{file} is being worked on for {by}, and one backup is made or checked at a time. Try again."
    ),
    "refused.backup-folder-silent": "The folder of the backups does not answer",
    "refused.backup-folder-silent.elsewhere": (
        "{folder} does not answer. If it is on another machine, see whether that can be reached; then try again."
    ),
    "refused.no-checkpoint": "There is no checkpoint yet",
    "refused.no-checkpoint.hourly": (
        "The station makes one every hour that it runs, and `sequence-planner journal checkpoint` at once."
    ),
    "refused.archive-unreadable": "The archive cannot be read",
    "refused.archive-unreadable.why": "{why^}.",
    "refused.history-failed": "The past cannot be looked at",
    "refused.history-failed.no-model": (
        "The server was started without the model of the station: start the station with `run`."
    ),
    # What could not be found out.
    "refused.worker-failed": "It could not be found out",
    "refused.worker-failed.again": "{why^}{end} Try again.",
    "refused.history-gone": "That was cut off",
    "refused.model-changed": "The model is another one",
    "refused.other-version": "Another version of the program has written it",
    "refused.history-differs": "The run cannot be replayed",
    "refused.history-unreadable": "The run cannot be replayed",
    "refused.history-timeout": "There was no answer in time",
    "refused.no-record.number": "The journal has no record {number}.",
    "refused.no-record.trimmed": "The journal has no record {number}: records up to {begin} were cut off.",
    "refused.history-differs.record": "The run cannot be replayed up to record {number}: {why}.",
    "refused.history-gone.record": (
        "Nothing tells how the station was at record {number}: what was before it was cut off."
    ),
    "refused.not-estimated.name": "There is no estimated variable `{name}`: only these can be corrected.",
    "refused.not-in-domain.of": "`{value}` is no value of `{name}`, which ranges over {range}.",
    "refused.model-changed.replay": "The run cannot be replayed with the model as it is now: {why}.",
    "refused.history-failed.replay": "The replay failed: {why}.",
    "refused.history-timeout.late": "There was no answer within {seconds} s. Ask for less, or try again later.",
    "refused.history-failed.ended": "The process that looks back has ended. Try again.",
    "target.https": "only https:// is sent to",
    "target.this-machine": "{host} is this machine ({address}), which is not sent to",
    "target.not-listed": (
        "{host}:{port} is not on the list of hosts that webhooks may go to; whoever runs the station puts it there "
        "with --webhook-host"
    ),
    "target.network-not-listed": (
        "{host}:{port} is not on the list of hosts that webhooks may go to; whoever runs the station puts it there "
        "with --webhook-host, or its network ({address}) with --webhook-network"
    ),
    "target.special": (
        "{host} has an address that is not public ({address}) and of a kind that is not sent to unless the list has "
        "exactly that address"
    ),
    "target.not-public": (
        "{host} has an address that is not public ({address}), in a network that is not on the list; whoever runs the "
        "station puts that there with --webhook-network"
    ),
    "target.not-this-machine": "{host} is not this machine ({address}): only https:// is sent to",
    "target.no-address": "{host} has no address",
    "target.no-network": "{written} is no network; write it as in 10.1.2.0/24",
    "target.every-network": "{written} is every network there is; write those that are meant",
    "target.no-host": "{written} is no host; write it as in mes.example:8443",
    "target.no-url": "this is no URL of the form https://host/path, of up to {most} characters",
    "target.password": "a URL with a user or a password in it is not sent to; deliveries are signed",
    "target.fragment": "a URL with a fragment is not sent to: no server would see it",
    "target.unresolved": "{host} cannot be resolved",
}
