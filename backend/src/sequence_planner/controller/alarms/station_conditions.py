"""Alarms of the station itself: its state, what people have asked of it, its records and its controller."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from sequence_planner.controller.alarms.alarm import UNSAFE, Cause, Consequences, listed
from sequence_planner.controller.commands.tasks import ProblemKind
from sequence_planner.controller.features.tasks import TaskProblem
from sequence_planner.controller.recovery.manual import Moved, WentOn
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import DeploymentView, Priority, QuestionView
from sequence_planner.controller.views.wording import value_text
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.language.printer import print_value

_UNJOURNALLED = "unjournalled"
_AT_REST = {
    Mode.AUTOMATIC: "in automatic mode",
    Mode.PAUSED: "paused",
    Mode.HOLD: "on hold",
    Mode.RESTART: "in restart mode",
}
_PROBLEMS = {
    ProblemKind.MISSING: "a part is missing",
    ProblemKind.DAMAGED: "something is damaged",
    ProblemKind.TOOL: "the tool does not work",
    ProblemKind.OTHER: "something else",
}


class StationAlarms:
    """Looks at `execution` and `outside`; what only others know, they set.

    `known` says what was known before the controller was started and is not now, and why it begins at rest; `undone` of
    which deployment the start failed.
    """

    def __init__(
        self, execution: Executor, outside: SafeStateMonitor, known: RestoredState, undone: DeploymentView | None = None
    ) -> None:
        self._execution = execution
        self._outside = outside
        self._left_out = known.left_out
        self._halted, self._begins = known.halted, execution.mode
        self._undone = undone
        self._consequences = Consequences(execution)
        self._conflicts: set[tuple[str, str, str]] = set()
        self.restless: tuple[str, ...] = ()  # abilities that finish again and again although nothing new is measured
        self.unrecorded: str | None = None  # why commands cannot be recorded
        self.unjournalled: str | None = None  # why what happens cannot be recorded
        self.kept: str | None = None  # what was asked for last that only a file beside the journal has
        self.failures: dict[str, str] = {}  # what of the controller's own work fails, and how
        self.undecided: Collection[str] = ()  # outputs on which a person must decide
        self.unemulated: Sequence[str] = ()  # why there are no emulated devices though there should be
        self.questions: Sequence[QuestionView] = ()  # where belief and measurement do not go together
        self.moved: Sequence[Moved] = ()  # what changed that nothing commanded
        self.problems: Mapping[str, tuple[str, TaskProblem]] = {}  # by task, each with the ability that waits for it

    def note(self, outcome: TickOutcome) -> None:
        """After a tick: a conflict is gone in the next one, and what came of it lasts until one of the two goes on."""
        gone_on = {*outcome.finished, *outcome.started}
        self._conflicts = {c for c in self._conflicts if gone_on.isdisjoint(c[:2])} | set(outcome.conflicts)

    def causes(self) -> Iterator[Cause]:
        """All that there are now."""
        yield from self._controller()
        yield from self._records()
        yield from self._state()
        yield from self._beginning()
        yield from self._belief()
        yield from self._deployment()
        yield from self._errand()
        yield from self._forces()
        yield from self._problems()
        yield from self._by_hand()

    def _controller(self) -> Iterator[Cause]:
        for what, how in self.failures.items():
            yield Cause(
                f"controller:{what}",
                Priority.HIGH,
                f"The controller fails at {what}: {how}",
                "It goes on trying. What it fails at is not done.",
                "Bring the station to rest, and give the controller's log to its maintainers.",
                past=f"The controller failed at {what}: {how}",
            )
        if self.restless:
            yield Cause(
                "restless",
                Priority.MEDIUM,
                f"{', '.join(self.restless)} finish again and again although nothing new is measured",
                "Their finish actions are taken many times over.",
                "Correct the model: after a finish its guard must no longer hold, or its actions change nothing.",
                past=f"{', '.join(self.restless)} finished again and again although nothing new was measured",
            )

    def _records(self) -> Iterator[Cause]:
        if self.unjournalled is not None:
            yield Cause(
                _UNJOURNALLED,
                Priority.HIGH,
                f"What happens cannot be recorded: {self.unjournalled}",
                self._consequences.standstill(),
                "It is tried again. Make room for the station's database, or bring it back.",
                past=f"What happened could not be recorded: {self.unjournalled}",
            )
        if self.unrecorded is not None:
            yield Cause(
                "unrecorded",
                Priority.HIGH,
                f"Commands cannot be recorded: {self.unrecorded}",
                "They are refused, but for pausing and holding.",
                "Make room for the station's database, or bring it back.",
                follows=(_UNJOURNALLED,),
                past=f"Commands could not be recorded: {self.unrecorded}",
            )

        if self.kept is not None:
            yield Cause(
                "kept-beside",
                Priority.MEDIUM,
                f"The journal does not have it yet: {self.kept}",
                "It is carried out, and kept on this machine. Nothing goes on by itself without it.",
                "Make room for the station's database, or bring it back.",
                past=f"The journal did not have it at once: {self.kept}",
            )

    def _state(self) -> Iterator[Cause]:
        situation = self._outside.situation
        # What is only possible with values that are unknown has an alarm of its own: the topic is silent.
        if situation is not None and situation.certain:
            yield Cause(
                UNSAFE,
                Priority.HIGH,
                self._outside.describe(situation),
                self._consequences.standstill(),
                self._outside.way(),
                past=self._outside.past(situation),
            )
        for one, other, variable in sorted(self._conflicts):
            yield Cause(
                f"conflict:{one}:{other}:{variable}",
                Priority.HIGH,
                f"{one} and {other} would finish with different values for {variable}",
                f"Neither was applied. {self._consequences.of_values({variable})}",
                "Correct the model.",
                past=f"{one} and {other} would have finished with different values for {variable}",
            )

    def _beginning(self) -> Iterator[Cause]:
        """Yield why it stands, until somebody has decided otherwise."""
        if self._halted is not None and self._execution.mode is not self._begins:
            self._halted = None
        if self._halted is not None:
            yield Cause(
                "begins-at-rest",
                Priority.MEDIUM,
                f"The station begins {_AT_REST[self._begins]}: {self._halted}",
                "Nothing starts until a person lets it go on.",
                "Find out whether somebody has stopped the station, and why. Then let it go on.",
                past=f"The station began {_AT_REST[self._begins]}: {self._halted}",
            )

    def _belief(self) -> Iterator[Cause]:
        if self.questions:
            first = self.questions[0]
            texts = [f"{each.variable} is believed to be {print_value(each.believed)}" for each in self.questions]
            past = [f"{each.variable} was believed to be {print_value(each.believed)}" for each in self.questions]
            yield Cause(
                "contradiction",
                Priority.MEDIUM,
                f"{texts[0]}, which does not go together with what is measured: {'; '.join(first.because)}",
                self._consequences.of_values({each.variable for each in self.questions}),
                f"Look at what {first.variable} stands for, and correct it or the device.",
                parts=() if len(texts) == 1 else tuple(texts),
                past=f"{past[0]}, which did not go together with what was measured",
                past_parts=() if len(past) == 1 else tuple(past),
                about=frozenset(each.variable for each in self.questions),
            )
        if self._left_out and self._execution.production is not Production.STARTED:
            left_out, *others = self._left_out
            more = f", and {len(others)} more" if others else ""
            yield Cause(
                "not-restored",
                Priority.MEDIUM,
                f"Not all that was known before the controller was started is known now: {left_out}{more}",
                "The station begins there as its model says, which may not be so.",
                "See how the station stands, and correct what is believed before production is started.",
                parts=self._left_out if others else (),
                past=f"Not all that was known before the controller was started was known after it: {left_out}{more}",
                past_parts=self._left_out if others else (),
            )
        if self.undecided:
            names = sorted(self.undecided)
            yield Cause(
                "undecided-outputs",
                Priority.MEDIUM,
                f"Outputs came back from the journal, and devices would react to them: {', '.join(names)}",
                "Production cannot be started.",
                "Decide for each whether the device shall react, or stay as it is.",
                past=f"Outputs had come back from the journal, and somebody had to decide on them: {', '.join(names)}",
            )

    def _deployment(self) -> Iterator[Cause]:
        if self._undone is not None and self._execution.production is not Production.STARTED:
            yield Cause(
                "deployment-undone",
                Priority.HIGH,
                f"The revision “{self._undone.name}” could not be started, and the model before is back: "
                f"{self._undone.why}",
                "The station runs as before the deployment. Nothing is started by itself.",
                "Change the draft, and deploy it again; or start production with the model that is back.",
                past=f"The revision “{self._undone.name}” could not be started, and the model before came back",
            )
        if self.unemulated:
            first, *others = self.unemulated
            yield Cause(
                "not-emulated",
                Priority.HIGH,
                f"There are no emulated devices, since they cannot be run with this model: {first}",
                "No device says or does anything.",
                "Change the model in the draft, and deploy it.",
                parts=tuple(self.unemulated) if others else (),
                past="There were no emulated devices, since they could not be run with the model",
                past_parts=tuple(self.unemulated) if others else (),
            )

    def _errand(self) -> Iterator[Cause]:
        last = self._execution.conduct.last_errand
        # Who has ended it knows of it; and once operations are executed again it is past.
        if last is None or last.done or last.by is not None or self._execution.errand is not None:
            return
        if self._execution.mode is not Mode.AUTOMATIC:
            text = f"“{last.title}” was not carried out to its end: {last.why}"
            yield Cause(
                f"errand:{last.ended.epoch}",
                Priority.MEDIUM,
                text,
                "Its goal was not reached, and no more of it is started.",
                "See how the station stands now, and which ways there are.",
                past=text,
            )

    def _forces(self) -> Iterator[Cause]:
        for name, force in self._execution.conduct.forces.items():
            yield Cause(
                f"forced:{name}",
                Priority.LOW,
                f"{name} is forced to {print_value(force.value)} by {force.by}: {force.why}",
                "Whatever its device or an ability says does not count meanwhile."
                if self._execution.production is Production.STARTED
                else "It is so also when production is started.",
                "It ends by itself; it can be released before.",
                past=f"{name} was forced to {print_value(force.value)} by {force.by}: {force.why}",
            )

    def _problems(self) -> Iterator[Cause]:
        """One of each task that somebody cannot do."""
        for task, (name, problem) in self.problems.items():
            ability = self._execution.automaton.abilities[name]
            said = ("" if problem.what is None else _PROBLEMS[problem.what], problem.why)
            why = f": {', '.join(filter(None, said))}" if any(said) else ""
            waiting = self._consequences.waiting(self._consequences.held_up({ability.resource}))
            yield Cause(
                f"problem:{task}",
                Priority.MEDIUM,
                f"{problem.by} has a problem with “{ability.title}”{why}",
                f"The task is not done. {waiting}",
                "Go there and help. It ends when the task is done or withdrawn, or somebody says that it is solved.",
                past=f"{problem.by} had a problem with “{ability.title}”{why}",
            )

    def _by_hand(self) -> Iterator[Cause]:
        """One of each resource that was last moved by hand."""
        automaton = self._execution.automaton
        for moved in self.moved:
            changed = listed(
                f"{value_text(automaton, name, after)} (before: {print_value(before)})"
                for name, (before, after) in moved.values.items()
            )
            text = f"{automaton.resources.get(moved.resource, moved.resource)} says {changed}, which nothing commanded"
            yield Cause(
                f"by-hand:{moved.resource}",
                Priority.LOW,
                text,
                self._went_on(moved),
                "Somebody may have moved it by hand. If so, look whether what the station believes is still true.",
                past=text,
            )

    def _went_on(self, moved: Moved) -> str:
        if moved.by is None:
            return "Nothing has been started because of it yet."
        title = self._execution.automaton.abilities[moved.by].title
        if moved.how is WentOn.EXECUTES:
            return f"“{title}” is under way again, as it was commanded before."
        if moved.how is WentOn.FINISHED:
            return f"“{title}” counts as finished by it."
        return f"“{title}” was started after it."
