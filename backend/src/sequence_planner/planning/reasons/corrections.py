"""What would bring a plan back: the fewest values of estimated variables, resources, or abilities out of service, that
need be different.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import combinations, product

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Kind
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Task
from sequence_planner.planning.pdr.engine import Reachability
from sequence_planner.planning.pdr.invariants import asserted, satisfies
from sequence_planner.planning.plan import Contract, Plan, Proof
from sequence_planner.planning.reasons.ready_answers import ReadyAnswers
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.replaying.replay import missing
from sequence_planner.planning.replaying.tightening import tightened

MOST_CHANGES = 2
MOST_FOUND = 5
_NOTHING_TO_DO = Plan((), minimal_ticks=True, minimal_starts=True)


class Change(Immutable):
    """An estimated variable has another `value`.

    With None, an offline resource is back online; or what is back, in service, is an `ability`.
    """

    name: str
    value: Value | None
    ability: bool = False


class Correction(Immutable):
    """With these changes there is a plan from a safe state, such as `plan`, which need not be the shortest.

    It has no ticks where the changes alone say that the goals are reached.
    """

    changes: tuple[Change, ...]
    plan: Plan


def corrections(
    automaton: Automaton,
    supervisor: Supervisor,
    task: Task,
    budget: Budget,
    most_changes: int = MOST_CHANGES,
    most_found: int = MOST_FOUND,
) -> tuple[Correction, ...]:
    """Corrections of the fewest changes, of which there are at most `most_changes`, and up to `most_found` of these.

    It is proven that no fewer changes bring a plan back. Those that only say that the goals are reached are left out,
    unless there is no other. What is unknown stays unknown. When the budget is spent, what has been found of the fewest
    changes.
    """
    return tuple(_Corrections(automaton, supervisor, task, budget, most_changes).found(most_found))


class _Corrections:
    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, task: Task, budget: Budget, most_changes: int
    ) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._task = replace(task, contract=Contract.FAST)
        self._budget = budget
        self._most_changes = most_changes
        self._engine = Reachability(automaton, supervisor)
        self._ready = ReadyAnswers(automaton, supervisor)
        self._acceptance = Acceptance(automaton, supervisor)
        self._refuted: list[tuple[Task, Proof]] = []

    def found(self, most: int) -> Iterator[Correction]:
        """Those of the fewest changes."""
        restating: list[tuple[Change, ...]] = []
        number = 0
        with suppress(SpentError):
            for size in range(1, self._most_changes + 1):
                for changes, task in self._safe(size):
                    if not task.goals:
                        restating.append(changes)
                    elif (plan := self._plan(task)) is not None:
                        yield Correction(changes, plan)
                        number += 1
                        if number == most:
                            return
                if number:
                    return
        if not number:
            fewest = [each for each in restating if len(each) == len(restating[0])]
            yield from (Correction(changes, _NOTHING_TO_DO) for changes in fewest[:most])

    def _safe(self, size: int) -> Iterator[tuple[tuple[Change, ...], Task]]:
        """All sets of so many changes that lead into a safe state, with what is left to do. Raises `SpentError`."""
        for changes in self._candidates(size):
            self._budget.require()
            task = self._changed(changes)
            if self._supervisor.safe.includes(task.state):
                yield changes, task

    def _candidates(self, size: int) -> Iterator[tuple[Change, ...]]:
        """All sets of so many changes."""
        for subjects in combinations(self._options().values(), size):
            yield from product(*subjects)

    def _options(self) -> Mapping[str, tuple[Change, ...]]:
        """The changes of each variable, resource and ability."""
        state = self._task.state
        options: dict[str, tuple[Change, ...]] = {}
        for name in self._automaton.names(Kind.ESTIMATED):
            if state[name] is not None:
                domain = self._automaton.variables[name].type.domain
                options[name] = tuple(Change(name, value) for value in domain if value != state[name])
        for resource in sorted(self._task.circumstances.offline):
            options[f"resource {resource}"] = (Change(resource, None),)
        for ability in sorted(self._task.circumstances.barred):
            options[f"ability {ability}"] = (Change(ability, None, ability=True),)
        return options

    def _plan(self, task: Task) -> Plan | None:
        """A plan, if there is one. Raises `SpentError`."""
        if any(_covers(refuted, proof, task) for refuted, proof in self._refuted):
            return None
        finding = self._ready.answer(task, self._budget)
        if not finding.decided:
            finding = self._engine.solve(task, self._budget)
        if finding.plan is None:
            if finding.proof is None:
                raise SpentError
            self._refuted.append((task, finding.proof))
            return None
        early = tightened(self._acceptance, task, finding.plan, self._budget)
        return finding.plan if early is None else early.plan

    def _changed(self, changes: tuple[Change, ...]) -> Task:
        values = {change.name: change.value for change in changes if change.value is not None}
        state = synchronise(self._automaton, {**self._task.state, **values})
        back = {change.name for change in changes if change.value is None and not change.ability}
        served = {change.name for change in changes if change.ability}
        circumstances = self._task.circumstances
        circumstances = replace(
            circumstances, offline=circumstances.offline - back, barred=circumstances.barred - served
        )
        return replace(self._task, state=state, goals=missing(self._task.goals, state), circumstances=circumstances)


def _covers(refuted: Task, proof: Proof, task: Task) -> bool:
    """Whether the proof for `refuted` is one for `task` too: no more may happen, and its invariant holds at first."""
    return (
        refuted.goals == task.goals
        and refuted.circumstances.offline <= task.circumstances.offline
        and refuted.circumstances.barred <= task.circumstances.barred
        and satisfies(asserted(task.state, task.goals), proof.invariant)
    )
