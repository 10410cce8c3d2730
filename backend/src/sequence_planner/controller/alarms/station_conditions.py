"""Alarms of the station itself: its state, what people have asked of it, its records and its controller."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from sequence_planner.controller.alarms.alarm import Consequences
from sequence_planner.controller.alarms.kinds import (
    BEGINS_AT_REST,
    BY_HAND,
    CONFLICT,
    CONTRADICTION,
    CONTROLLER,
    DEPLOYMENT_UNDONE,
    ERRAND,
    FORCED,
    KEPT_BESIDE,
    NOT_EMULATED,
    NOT_RESTORED,
    PROBLEM,
    RESTLESS,
    UNDECIDED_OUTPUTS,
    UNJOURNALLED,
    UNRECORDED,
    UNSAFE_STATE,
    Cause,
)
from sequence_planner.controller.features.tasks import TaskProblem
from sequence_planner.controller.recovery.manual import Moved, WentOn
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import DeploymentView, QuestionView
from sequence_planner.controller.views.wording import ended_text, title_text, value_text
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.language.printer import print_value
from sequence_planner.texts.message import Argument, Message, as_it_was, message


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
        yield from self._operator_plan()
        yield from self._forces()
        yield from self._problems()
        yield from self._by_hand()

    def _controller(self) -> Iterator[Cause]:
        for what, how in self.failures.items():
            yield CONTROLLER.cause(what, {"what": what, "how": how})
        if self.restless:
            yield RESTLESS.cause("", {"abilities": ", ".join(self.restless)})

    def _records(self) -> Iterator[Cause]:
        if self.unjournalled is not None:
            yield UNJOURNALLED.cause("", {"why": self.unjournalled, "waiting": self._consequences.standstill()})
        if self.unrecorded is not None:
            yield UNRECORDED.cause("", {"why": self.unrecorded}, follows=(UNJOURNALLED.key(),))
        if self.kept is not None:
            yield KEPT_BESIDE.cause("", {"what": self.kept})

    def _state(self) -> Iterator[Cause]:
        situation = self._outside.situation
        # What is only possible with values that are unknown has an alarm of its own: the topic is silent.
        if situation is not None and situation.certain:
            yield UNSAFE_STATE.cause(
                "",
                {
                    "what": self._outside.describe(situation),
                    "what_past": self._outside.past(situation),
                    "waiting": self._consequences.standstill(),
                    "way": self._outside.way(),
                },
            )
        automaton = self._execution.automaton
        for one, other, variable in sorted(self._conflicts):
            yield CONFLICT.cause(
                f"{one}:{other}:{variable}",
                {
                    "one": one,
                    "other": other,
                    "variable": variable,
                    "consequence": self._consequences.of_values({variable}),
                },
                resources=dict.fromkeys(
                    automaton.abilities[name].resource for name in (one, other) if name in automaton.abilities
                ),
            )

    def _beginning(self) -> Iterator[Cause]:
        """Yield why it stands, until somebody has decided otherwise."""
        if self._halted is not None and self._execution.mode is not self._begins:
            self._halted = None
        if self._halted is not None:
            yield BEGINS_AT_REST.cause("", {"mode": message(f"at-rest.{self._begins}"), "why": self._halted})

    def _belief(self) -> Iterator[Cause]:
        if self.questions:
            first = self.questions[0]
            asked = [(each.variable, print_value(each.believed)) for each in self.questions]
            texts = [message("contradiction.believed", variable=name, value=value) for name, value in asked]
            past = [message("contradiction.believed-past", variable=name, value=value) for name, value in asked]
            yield CONTRADICTION.cause(
                "",
                {
                    "first": texts[0],
                    "first_past": past[0],
                    "because": "; ".join(first.because),
                    "consequence": self._consequences.of_values({each.variable for each in self.questions}),
                    "variable": first.variable,
                },
                parts=texts,
                past_parts=past,
                about=frozenset(each.variable for each in self.questions),
            )
        started = self._execution.production is Production.STARTED
        if self._left_out and not started:
            first_lost, *others = self._left_out
            parts = [*map(as_it_was, self._left_out)]
            more = message("not-restored.more", count=len(others)) if others else ""
            yield NOT_RESTORED.cause("", {"first": first_lost, "more": more}, parts=parts, past_parts=parts)
        if self.undecided:
            yield UNDECIDED_OUTPUTS.cause("", {"outputs": ", ".join(sorted(self.undecided))})

    def _deployment(self) -> Iterator[Cause]:
        if self._undone is not None and self._execution.production is not Production.STARTED:
            yield DEPLOYMENT_UNDONE.cause("", {"revision": self._undone.name, "why": self._undone.why or ""})
        if self.unemulated:
            parts = [*map(as_it_was, self.unemulated)]
            yield NOT_EMULATED.cause("", {"why": self.unemulated[0]}, parts=parts, past_parts=parts)

    def _operator_plan(self) -> Iterator[Cause]:
        last = self._execution.conduct.last_operator_plan
        # Who has ended it knows of it; and once operations are executed again it is past.
        if last is None or last.done or last.by is not None or self._execution.operator_plan is not None:
            return
        if self._execution.mode is not Mode.AUTOMATIC:
            yield ERRAND.cause(
                str(last.ended.epoch),
                {"title": message("quoted", title=title_text(last.title)), "why": ended_text(last.why)},
            )

    def _forces(self) -> Iterator[Cause]:
        started = self._execution.production is Production.STARTED
        for name, force in self._execution.conduct.forces.items():
            resource = self._execution.automaton.variables[name].resource
            yield FORCED.cause(
                name,
                {
                    "variable": name,
                    "value": print_value(force.value),
                    "by": force.by,
                    "why": force.why,
                    "consequence": message("forced.ignored") if started else message("forced.later"),
                },
                resources=[] if resource is None else [resource],
            )

    def _problems(self) -> Iterator[Cause]:
        """One of each task that somebody cannot do."""
        for task, (name, problem) in self.problems.items():
            ability = self._execution.automaton.abilities[name]
            what = None if problem.what is None else message(f"problem.{problem.what}")
            said: Argument = message("problem-both", what=what, why=problem.why) if what and problem.why else ""
            said = said or what or problem.why
            yield PROBLEM.cause(
                task,
                {
                    "by": problem.by,
                    "ability": message("quoted", title=ability.title),
                    "what": message("problem-said", said=said) if said else "",
                    "waiting": self._consequences.waiting(self._consequences.held_up({ability.resource})),
                },
                resources=[ability.resource],
            )

    def _by_hand(self) -> Iterator[Cause]:
        """One of each resource that was last moved by hand."""
        automaton = self._execution.automaton
        for moved in self.moved:
            values = [
                message("by-hand.value", value=value_text(automaton, name, after), before=print_value(before))
                for name, (before, after) in moved.values.items()
            ]
            resource = automaton.resources.get(moved.resource, moved.resource)
            yield BY_HAND.cause(
                moved.resource,
                {"resource": resource, "values": values, "went_on": self._went_on(moved)},
                resources=[moved.resource],
            )

    def _went_on(self, moved: Moved) -> Message:
        if moved.by is None:
            return message("by-hand.nothing")
        title = message("quoted", title=self._execution.automaton.abilities[moved.by].title)
        if moved.how is WentOn.EXECUTES:
            return message("by-hand.executes", ability=title)
        return message("by-hand.finished" if moved.how is WentOn.FINISHED else "by-hand.started", ability=title)
