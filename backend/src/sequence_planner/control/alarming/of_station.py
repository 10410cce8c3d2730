"""Alarms of the station itself: its state, what people have asked of it, its records and its controller."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from sequence_planner.control.alarm_view import Priority
from sequence_planner.control.alarming.cause import Cause
from sequence_planner.control.alarming.consequence import Consequences
from sequence_planner.control.execution import Execution
from sequence_planner.control.heard import TickOutcome
from sequence_planner.control.outside import Outside
from sequence_planner.control.restart_view import QuestionView
from sequence_planner.control.tasks import TaskProblem
from sequence_planner.control.view import Mode, Production
from sequence_planner.expressions.printing import print_value

_UNJOURNALLED = "unjournalled"


class StationAlarms:
    """Looks at `execution` and `outside`; what only others know, they set.

    `left_out` says what was known before the controller was started and is not now.
    """

    def __init__(self, execution: Execution, outside: Outside, left_out: tuple[str, ...]) -> None:
        self._execution = execution
        self._outside = outside
        self._left_out = left_out
        self._consequences = Consequences(execution)
        self._conflicts: set[tuple[str, str, str]] = set()
        self.restless: tuple[str, ...] = ()  # abilities that finish again and again although nothing new is measured
        self.unrecorded: str | None = None  # why commands cannot be recorded
        self.unjournalled: str | None = None  # why what happens cannot be recorded
        self.failures: dict[str, str] = {}  # what of the controller's own work fails, and how
        self.undecided: Collection[str] = ()  # outputs on which a person must decide
        self.questions: Sequence[QuestionView] = ()  # where belief and measurement do not go together
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
        yield from self._belief()
        yield from self._errand()
        yield from self._forces()
        yield from self._problems()

    def _controller(self) -> Iterator[Cause]:
        for what, how in self.failures.items():
            yield Cause(
                f"controller:{what}",
                Priority.HIGH,
                f"The controller fails at {what}: {how}",
                "It goes on trying. What it fails at is not done.",
                "Bring the station to rest, and give the controller's log to its maintainers.",
            )
        if self.restless:
            yield Cause(
                "restless",
                Priority.MEDIUM,
                f"{', '.join(self.restless)} finish again and again although nothing new is measured",
                "Their finish actions are taken many times over.",
                "Correct the model: after a finish its guard must no longer hold, or its actions change nothing.",
            )

    def _records(self) -> Iterator[Cause]:
        if self.unjournalled is not None:
            yield Cause(
                _UNJOURNALLED,
                Priority.HIGH,
                f"What happens cannot be recorded: {self.unjournalled}",
                self._consequences.standstill(),
                "It is tried again. Make room for the station's database, or bring it back.",
            )
        if self.unrecorded is not None:
            yield Cause(
                "unrecorded",
                Priority.HIGH,
                f"Commands cannot be recorded: {self.unrecorded}",
                "They are refused, but for pausing and holding.",
                "Make room for the station's database, or bring it back.",
                follows=(_UNJOURNALLED,),
            )

    def _state(self) -> Iterator[Cause]:
        situation = self._outside.situation
        # What is only possible with values that are unknown has an alarm of its own: the topic is silent.
        if situation is not None and situation.certain:
            yield Cause(
                "unsafe-state",
                Priority.HIGH,
                self._outside.describe(situation),
                self._consequences.standstill(),
                self._outside.way(),
            )
        for one, other, variable in sorted(self._conflicts):
            yield Cause(
                f"conflict:{one}:{other}:{variable}",
                Priority.HIGH,
                f"{one} and {other} would finish with different values for {variable}",
                f"Neither was applied. {self._consequences.of_values({variable})}",
                "Correct the model.",
            )

    def _belief(self) -> Iterator[Cause]:
        if self.questions:
            first = self.questions[0]
            texts = [f"{each.variable} is believed to be {print_value(each.believed)}" for each in self.questions]
            yield Cause(
                "contradiction",
                Priority.MEDIUM,
                f"{texts[0]}, which does not go together with what is measured: {'; '.join(first.because)}",
                self._consequences.of_values({each.variable for each in self.questions}),
                f"Look at what {first.variable} stands for, and correct it or the device.",
                parts=() if len(texts) == 1 else tuple(texts),
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
            )
        if self.undecided:
            names = sorted(self.undecided)
            yield Cause(
                "undecided-outputs",
                Priority.MEDIUM,
                f"Outputs came back from the journal, and devices would react to them: {', '.join(names)}",
                "Production cannot be started.",
                "Decide for each whether the device shall react, or stay as it is.",
            )

    def _errand(self) -> Iterator[Cause]:
        last = self._execution.conduct.last_errand
        # Who has ended it knows of it; and once operations are executed again it is past.
        if last is None or last.done or last.by is not None or self._execution.errand is not None:
            return
        if self._execution.mode is not Mode.AUTOMATIC:
            yield Cause(
                f"errand:{last.ended.epoch}",
                Priority.MEDIUM,
                f"“{last.title}” was not carried out to its end: {last.why}",
                "Its goal was not reached, and no more of it is started.",
                "See how the station stands now, and which ways there are.",
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
            )

    def _problems(self) -> Iterator[Cause]:
        """One of each task that somebody cannot do."""
        for task, (name, problem) in self.problems.items():
            ability = self._execution.automaton.abilities[name]
            why = f": {problem.why}" if problem.why else ""
            waiting = self._consequences.waiting(self._consequences.held_up({ability.resource}))
            yield Cause(
                f"problem:{task}",
                Priority.MEDIUM,
                f"{problem.by} has a problem with “{ability.title}”{why}",
                f"The task is not done. {waiting}",
                "Go there and help. It ends when the task is done or withdrawn, or somebody says that it is solved.",
            )
