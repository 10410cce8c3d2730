"""English texts of what is found in a model by checks and synthesis, and of what is answered about a whole model."""

from __future__ import annotations

from typing import Final

FINDINGS: Final[dict[str, str]] = {
    # What findings are made of: names and conditions are the model's own, in backticks.
    "found.more": "{names} and {count} more{rest||}",
    "found.for": "for {over}: {what}",
    "found.in": "in {instances}: {what}",
    "found.of": "of {names}: {what}",
    "found.each": "each of {names}",
    "found.subject": "{subject} {what}",
    "found.hidden": "{count} more {count|finding is|findings are} not shown: mend those before this one first",
    # Names and values without a use or an origin.
    "found.never-used": "nothing uses the {what} `{name}`: leave it out, or use it",
    "found.never-used.set": "set",
    "found.never-used.relation": "relation",
    "found.never-used.map": "map",
    "found.never-used.predicate": "predicate",
    "found.never-given": (
        "no message ever makes `{variable}` {values}, since this `{stage}` never gives {count|it|them}, and emulated "
        "devices cannot say {count|it|them}: let the stage give {count|it|them}, or take {count|it|them} out of the "
        "type of `{variable}`"
    ),
    "found.always-late": (
        "`{ability}` usually takes {shortest} to {longest} s and must finish within {limit} s: each run is told to be "
        "late. Give it more time under `timeouts`, or mend its `duration`"
    ),
    "found.often-late": (
        "`{ability}` usually takes {shortest} to {longest} s and must finish within {limit} s: runs are told to be "
        "late that take no longer than usual. Give it more time under `timeouts`, or mend its `duration`"
    ),
    "found.nothing-feeds": (
        "no topic feeds `{variable}`, and it is no acknowledgement: it stays unknown, and what depends on it never "
        "happens. Give it a field of an incoming topic, or make it an estimate if no message says it"
    ),
    "found.carried-nowhere": (
        "no topic carries `{variable}`: no device ever hears of it. Give it a field of an outgoing topic, or make it "
        "an estimate if it is not for a device"
    ),
    "found.never-written": (
        "no ability writes `{variable}`: it stays `{value}`. Write the action that is missing, or leave it out"
    ),
    "found.never-read": (
        "nothing reads {names}: leave {count|it|them} out, and list {count|its field|their fields} under `ignore` if a "
        "message has {count|it|them}"
    ),
    # What is written and says nothing, or too much.
    "found.no-operation": (
        "there is no operation here, so the station never does anything by itself: write one, or delete the file"
    ),
    "found.no-specification": (
        "there is no specification here, so nothing is forbidden: write one, or delete the file"
    ),
    "found.forbids-nothing": (
        "`{specification}` forbids nothing: no state, reachable or not, is as it says (see `show`). An ability without "
        "`executing` never executes, so it excludes nothing either"
    ),
    "found.empty-local-specification": (
        "the local specification `{formula}` of `{operation}` reads no variable, so it only says how long the run is: "
        "write what must hold on the way, or leave it out"
    ),
    "found.contradictory-effects": (
        "`{one}` and `{other}` happen under the same condition and write different values to {variables}: a plan "
        "counts on whichever suits it. Let their conditions exclude each other, or mark the one that nobody is to "
        "count on with `fault: true`"
    ),
    "found.relies-on-executing": (
        "`{ability}` finishes only after it was seen executing, and right after its start `{condition}` may not hold "
        "yet: a device that is done before a message says that it is at work is never seen to finish. Let the finish "
        "guard read the command and the result instead of `executing`"
    ),
    "found.shared-acknowledgement": (
        "the tasks of `{one}` and `{other}` can be open at once ({when}), and `{acknowledgement}` acknowledges both: "
        "give each its own, or let `executing` tell which one is asked for"
    ),
    "found.task-never-open": (
        "the task of `{ability}` is never open: a task is open while its ability executes, and this one never does. "
        "Write `executing`, such as that the request is there and the acknowledgement is not"
    ),
    "found.write-conflict": (
        "the finishes of `{one}` and `{other}` would write different values to `{variable}`, and then neither is "
        "applied. They {how}: {values}. Let their finish guards exclude each other"
    ),
    "found.write-conflict.meet": "meet in a reachable state",
    "found.write-conflict.may-meet": (
        "might meet (there are too many states to say whether such a one can be reached)"
    ),
    # Conditions that always hold, or never.
    "found.always-holds": (
        "{condition} always holds, whatever the values of its variables: leave it out, or write what was meant"
    ),
    "found.never-holds": "{condition} never holds, whatever the values of its variables: write what was meant",
    "found.alarm-always": (
        "the alarm `{alarm}` is always there, since {condition} always holds: write when it is to be there"
    ),
    "found.alarm-never": (
        "the alarm `{alarm}` is never there, since {condition} never holds: write when it is to be there"
    ),
    "found.meant": "{what}{so}: write what was meant",
    "found.meant.exclude": "{one} and {other} exclude each other",
    "found.meant.never": "{condition} never holds",
    "found.meant.never-that-is": "{condition}, that is {meaning}, never holds",
    "found.unreachable": (
        "nothing ever makes {condition} true, neither an action nor a message{so}: write what was meant, or the action "
        "that is missing"
    ),
    "found.effect-never-happens": (
        "nothing ever makes {condition} true, so this effect never happens: no output and no other effect leads to it"
    ),
    "found.nothing-brings-about": (
        "no effect brings about {condition}{so} in any plan: write the effect with which the device does it"
    ),
    "found.so.effect": ", so the effect never happens",
    "found.so.inactive": ", so the operation never becomes active",
    "found.so.out-of-turn": ", so `{operation}` never becomes active in the sequence `{sequence}`, {turn}",
    "found.so.incomplete": ", so the operation is never completed",
    "found.so.unstarted": ", so the ability never starts",
    "found.so.unfinished": ", so the ability never finishes",
    "found.turn.behind": "behind {names}",
    "found.turn.beside": "beside {names}",
    # What is never possible in the states that can be reached.
    "found.too-many-states": (
        "of {names} it is not known whether they are always possible: too many states bear on them to be looked at. "
        "Check parts of the station on their own"
    ),
    "found.never-starts": "never starts: {why}",
    "found.never-active": "never becomes active: {why}",
    "found.never-active.sequence": "never becomes active in the sequence `{sequence}`, {turn}: {why}",
    "found.never-reached": (
        "{condition} holds in no state that can be reached, with or without the supervisor. Write what was meant, or "
        "the action or effect that is missing"
    ),
    "found.start-beyond": (
        "never starts under the supervisor: its guards hold only {after}. Let another way lead there, forbid less, or "
        "leave it out"
    ),
    "found.never-allowed": (
        "never starts, as the supervisor forbids it wherever it could: it would lead to {what}. Let something else "
        "happen before it, forbid less, or leave it out"
    ),
    "found.leads-to.broken": "what {specifications} forbids",
    "found.leads-to.restless": "states from which rest cannot be reached any more",
    "found.leads-to.either": "{one}, or to {other}",
    "found.active-beyond": (
        "never becomes active under the supervisor: its precondition holds only {after}. Let another way lead there, "
        "or forbid less"
    ),
    "found.after": "after states that are not safe",
    "found.after.breaks": ("after states that are not safe: step {step} of the shortest way breaks {specifications}"),
    "found.after.could-break": (
        "after states that are not safe: after step {step} of the shortest way {specifications} could be broken "
        "without any start"
    ),
    "found.after.restless": (
        "after states that are not safe: after step {step} of the shortest way it is no longer certain that rest can "
        "be reached"
    ),
    "found.goal-lost": (
        "cannot be completed under the supervisor, though it could without it: its goal holds only {after}. Let "
        "another way lead there, or forbid less"
    ),
    "found.goal-lost.plain": (
        "cannot be reached under the supervisor, though it could without it: it holds only {after}. Let another way "
        "lead there, or forbid less"
    ),
    "found.goal-out-of-reach.plain": (
        "cannot be reached, with or without the supervisor: write what was meant, or what is missing"
    ),
    "found.goal-out-of-reach.initial": (
        "cannot always be completed: in the initial state its precondition holds, and its goal cannot be reached any "
        "more, as {cause}. Let the precondition exclude that, or add what is missing"
    ),
    "found.goal-out-of-reach.later": (
        "cannot always be completed: after some steps its precondition holds, and its goal cannot be reached any more, "
        "as {cause}. Let the precondition exclude that, or add what is missing"
    ),
    "found.goal-out-of-reach.fault": (
        "cannot be completed once there was the fault `{fault}`, which nobody counts on: its precondition holds, and "
        "its goal cannot be reached any more, as {cause}. Let the precondition exclude that, or add what is missing, "
        "unless that much is lost with the fault"
    ),
    "found.goal-out-of-reach.person": (
        "cannot be completed once a person has done `{fault}`, which nobody counts on: its precondition holds, and its "
        "goal cannot be reached any more, as {cause}. That is as it should be where the person meant it; let the "
        "precondition exclude it where not"
    ),
    "found.cause.allowed": "nothing that the supervisor allows leads there",
    "found.cause.forbidden": "the supervisor forbids all that would lead there",
    "found.cause.nothing": "no ability and no effect leads there, with or without the supervisor",
    "found.never-brought": (
        "no job of `{work_master}` ever begins: its product brings `{values}`, and {why}. Bring what is safe, or let "
        "the specification be about less"
    ),
    "found.never-brought.forbidden": "{specifications} forbids it",
    "found.never-brought.unsafe": "it is so in no safe state",
    # Why there is no supervisor.
    "found.unmet": "{why}. {conflict}",
    "found.unmet.devices": "specification {specifications} cannot be met: the devices alone can break it",
    "found.unmet.initial": (
        "specification {specifications} cannot be met: the initial state breaks it, with {values}. Begin in another "
        "state, or forbid less"
    ),
    "found.unmet.an-initial": (
        "specification {specifications} cannot be met: an initial state breaks it, with {values}. Begin in another "
        "state, or forbid less"
    ),
    "found.unmet.no-start": (
        "specification {specifications} cannot be met: no start could prevent this from the initial state on"
    ),
    "found.rest.initial": "from the initial state no state described by `rest` in station.yaml can be reached",
    "found.rest.led": (
        "from where the devices alone can lead no state described by `rest` in station.yaml can be reached"
    ),
    "found.rest.initial-plain": "from the initial state no state described by `marked` can be reached",
    "found.rest.led-plain": (
        "from where uncontrollable transitions can lead no state described by `marked` can be reached"
    ),
    "found.rest.anyhow": (
        "{what}. So it is also without any specification: check `rest`, and the abilities and effects that should lead "
        "there (neither faults nor restart abilities are counted on)"
    ),
    "found.rest.anyhow-plain": (
        "{what}. So it is also without `forbidden`: check `marked`, and the transitions that should lead there"
    ),
    "found.rest.barred": (
        "{what} safely: the shortest way there {barred}. Let another way lead to {rest}, or forbid less; perhaps "
        "something uncontrollable should be left to an ability"
    ),
    "found.rest.breaks": "breaks {specifications} in step {step}",
    "found.rest.chance": "leaves it to chance, from step {step} on, whether {specifications} is broken",
    "found.rest.may-end": "may end, from step {step} on, where {rest} cannot be reached any more",
    "found.rest.rest": "rest",
    "found.rest.marked": "a marked state",
    "found.conflict": "Already these conflict: {specifications}",
    "found.conflict.uncontrollable": (
        "Already these conflict: {specifications}, with what no start decides: {uncontrollable}"
    ),
    "found.conflict.perhaps-fewer": "{conflict} (perhaps fewer would do: not all was tried)",
    # What is being found out.
    "pending.begins": "the check begins",
    "pending.reading": "reading it",
    "pending.suspicious": "what is suspicious",
    "pending.safe": "the safe states",
    "pending.why-none": "why they are none",
    "pending.findings": "the findings",
    "pending.far": "the findings that too many states bear on",
    "pending.guards": "the guards",
    "pending.counting": "the number of states",
    "pending.examples": "the examples of pipelines",
    # How two models differ.
    "comparing.reading": "both are read",
    "comparing.supervisor": "what the supervisor allows in either",
    "comparing.starts": "what may start where",
    "comparing.plans": "the plans of operations",
    "compare.seconds": "{seconds} s",
    "compare.range": "{least} to {most} s",
    "compare.replan": "a new plan, after {retries} tries",
    "compare.yes": "yes",
    "compare.no": "no",
    # Why a process has not found it out.
    "work.no-answer": "the process has ended without an answer; is memory short?",
    "work.late": "there was no answer within {seconds} s",
    "work.given-up": "it took more than {seconds} s and was given up",
    "work.memory": "it takes more than {gigabytes} GB of memory: allow more with --memory or {variable}",
    "work.outgrown": (
        "the sets of states have outgrown the memory set aside for them: let fewer or smaller variables bear on the "
        "specifications and on `rest`"
    ),
    "work.unsafe": (
        "the safe states could not be computed within {seconds} s: let fewer variables bear on them, or have "
        "`sequence-planner plan` find them with a longer --deadline before the next start"
    ),
    # Why an edit of the draft is not made.
    "edit.nothing-to-undo": "there is nothing of yours to undo",
    "edit.nothing-to-redo": "there is nothing of yours to do again",
    "edit.draft-changed": "the draft has changed since: look at its findings again",
    "edit.no-run": "there is no run that shows such a finding",
    "edit.no-ability": "the model has no ability `{name}`",
    "edit.unusable": "the model cannot be used: {place}: {what}",
    "edit.revision-name": "a revision needs a name of up to {most} characters",
    "edit.revision-taken": "there is a revision “{name}” already: choose another name",
    "edit.revision-same": "nothing differs from the revision “{name}”",
    "edit.no-revision": "there is no revision {revision}",
    "edit.file-gone": "{file} is not there any more",
    "edit.file-changed": "{file} was changed meanwhile {how}",
    "edit.file-changed.made": "in another way: it was made, or taken away",
    "edit.file-changed.lines": "in the same lines, from line {line} of the old text on",
    "edit.part-gone": "`{part}` is not there any more in {file}",
    "edit.part-changed": "`{part}` of {file} was changed meanwhile",
    "edit.by": "{what}, by {person}",
    "edit.no-pipeline": "the draft has no pipeline `{name}`",
    "edit.pipeline-unusable": "the pipeline cannot be run as it is in the draft: {why}",
    # What is missing or wrong in an outline of a station.
    "outline.no-devices": "nothing is there that could do anything: add a device",
    "outline.no-name": "a name is missing",
    "outline.taken-name": "something is called `{name}` already: take another name",
    "outline.taken-title": "something is called “{title}” already: nobody could tell them apart",
    "outline.braces": "a title cannot have braces: leave them out",
    "outline.no-poses": "{robot} has no poses: add those to which it is sent",
    "outline.other-joints": "the first pose has {count} {count|joint|joints}, this one has {here}",
    "outline.same-joints": "it cannot be told from {pose}: the joints are where they are there",
    "outline.too-few-states": "a product has a first state and a last one at least: add states",
    "outline.steps-missing": "there is one step between each state and the next: there are {states} states",
    "outline.nobody-does-it": "nobody does this: choose who brings the product into its next state",
    "outline.no-action": "say whether {device} opens or closes for this",
    "outline.closed-already": "{device} is closed then: let a step before this open it",
    "outline.open-already": "{device} is open then: let a step before this close it",
    "outline.stays-closed": "nothing opens {device} after this: add a step that does, or the next product finds it so",
    "outline.no-robot": "there is no such robot any more: choose another one, or take this away",
    "outline.no-pose": "{robot} has no such pose any more: choose another one",
    "outline.twice-robot": "{robot} cannot be in two poses: take one of them away",
    "outline.no-facts": "say what must never be, or take this away",
    "outline.at-first": "it is so at the beginning already: say more exactly what must never be",
    "outline.on-the-way": "the product comes through this when it is made: say more exactly what must never be",
    "outline.no-thing": "this is not there any more: choose something else, or take it away",
    "outline.no-value": "{thing} has no such value any more: choose another one",
    # Why no station may run a draft.
    "hindrance.why": "{why}.",
    "hindrance.not-checked": "The draft is not checked",
    "hindrance.not-checked.failed": "The draft could not be checked: {why}. Change the draft, then it is checked anew",
    "hindrance.not-checked.yet": (
        "The check of the draft has not ended yet. Try again when it has, as the page Check shows"
    ),
    "hindrance.check-found-errors": "The check has found errors",
    "hindrance.check-found-errors.one": (
        "The check has found an error at {place}: {what}. Mend the draft, save it, and deploy that"
    ),
    "hindrance.check-found-errors.several": (
        "The check has found {count} errors, the first at {place}: {what}. Mend the draft, save it, and deploy that"
    ),
    "hindrance.no-supervisor": "The draft has no supervisor",
    "hindrance.no-supervisor.mend": ("Nothing of the draft could be started. Mend the draft, save it, and deploy that"),
    "hindrance.no-supervisor.because": (
        "Nothing of the draft could be started: {place}: {what}. Mend the draft, save it, and deploy that"
    ),
    # Why nothing can be said of a model.
    "obstacle.at": "{place}: {what}",
    "obstacle.before": "what stands before it cannot be used",
    "obstacle.model.whole": "the model",
    "obstacle.model.older": "the older one",
    "obstacle.model.newer": "the newer one",
    "obstacle.unusable": "{model} cannot be used: {place}: {what}",
    "obstacle.unsupervised": "{model} has no supervisor: {why}",
}
