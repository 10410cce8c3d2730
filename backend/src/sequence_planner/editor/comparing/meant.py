"""What a model means: where its abilities may start, which states are reached, and how its operations are planned."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import NamedTuple

from sequence_planner.analysis.kept import KeptPlans
from sequence_planner.analysis.store import key, read, write
from sequence_planner.automaton.automaton import Ability, Automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE, Expression, conjunction, variables
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Contract, Goal, Plan, PlanRequest, Verdict, goal_of
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.synthesis.supervisor import relevant
from sequence_planner.synthesis.transition_relation import Plant

PLANNING = 2.0  # seconds for one plan


class Reach(NamedTuple):
    """Whether a state is reached: False where that is proven, None where nobody knows. `run` are the starts that lead
    there, where such a run was found.
    """

    found: bool | None
    run: list[str] | None = None


class Meant:
    """A model that can be used, with what synthesis has found of it; `reached` are the states of variables that bear on
    safety, None where these are too many to know.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        guards: Mapping[str, SupervisorGuard],
        reached: StateSet | None = None,
    ) -> None:
        self.automaton = automaton
        self.guards = {start: guard for guard in guards.values() for start in guard.starts}
        self.supervisor = supervisor
        self._reached = reached
        self._planner = Planner(automaton, supervisor)
        kept = read(key(automaton), KeptPlans)
        self._plans: dict[str, Plan | None] = {} if kept is None else dict(kept.plans)

    def known_plan(self, operation: str) -> Plan | None:
        """The shortest plan of an operation from the initial state, if it was found before."""
        return self._plans.get(operation)

    def plan_of(self, operation: str, budget: Budget) -> tuple[Plan | None, bool]:
        """The plan of an operation from the initial state, and whether that is proven to be the shortest, or none."""
        found = self.automaton.operations.get(operation)
        if found is None:
            return None, True
        if operation in self._plans:
            return self._plans[operation], True
        if budget.spent:
            return None, False
        plan, verdict = self._planned(goal_of(found), min(PLANNING, budget.remaining), Contract.MINIMAL)
        proven = verdict is Verdict.NONE_AT_ALL if plan is None else plan.minimal_ticks and plan.minimal_starts
        if proven:
            self._plans[operation] = plan
        return plan, proven

    def keep_plans(self) -> None:
        """Let those who compare this model with others know its plans."""
        if self._plans:
            write(key(self.automaton), KeptPlans(self._plans))

    def reach(self, predicate: Expression, seconds: float) -> Reach:
        """Say whether a state that satisfies `predicate` is reached from the initial one. A run there is looked for so
        long; it need not be the shortest one.
        """
        if not self.automaton.types.keys() >= set(variables(predicate)):
            return Reach(None)  # it is about what there is not here
        if holds(predicate, initial_state(self.automaton)):
            return Reach(True, [])
        proven = self._is_reached(predicate)
        if proven is False or not seconds:
            return Reach(proven)
        plan, verdict = self._planned(Goal("there", predicate), seconds, Contract.FAST)
        if plan is not None:
            return Reach(True, starts_of(plan))
        return Reach(False if proven is None and verdict is Verdict.NONE_AT_ALL else proven)

    def may_start(self, ability: Ability) -> Expression:
        """Say when it may start, as far as guards for people say that."""
        guard = self.guards.get(ability.name)
        added = TRUE if guard is None or guard.expression is None else guard.expression
        return conjunction(ability.enabled, ability.start_guard, added)

    def is_unsaid(self, ability: str) -> bool:
        """Return whether the supervisor restricts it, and no guard for people says where."""
        guard = self.guards.get(ability)
        return guard is not None and guard.expression is None

    @property
    def states(self) -> int | None:
        """How many states of what bears on safety are reached; None where that is not known."""
        return None if self._reached is None else self._plant.diagrams.count(self._around)

    def _is_reached(self, predicate: Expression) -> bool | None:
        """Say what the sets of states do: nothing outside the safe ones is reached from inside."""
        if not self._plant.says((predicate,)):
            return None
        if (self._around & self._plant.where(predicate)).satisfiable():
            return None if self._reached is None else True
        return False

    @cached_property
    def _around(self) -> Function:
        """The states that are reached, as far as that is known: else the safe ones, which are these and more."""
        known = self.supervisor.safe if self._reached is None else self._reached
        return self._plant.diagrams.imported(known) & self._plant.diagrams.valid

    @cached_property
    def _plant(self) -> Plant:
        return Plant(self.automaton, relevant(self.automaton))

    def _planned(self, goal: Goal, seconds: float, contract: Contract) -> tuple[Plan | None, Verdict]:
        state = dict(initial_state(self.automaton))
        answer = self._planner.answer(PlanRequest(state, (goal,), deadline=seconds, contract=contract))
        return answer.plan, answer.verdict


def starts_of(plan: Plan) -> list[str]:
    """The starts of a plan, in their order."""
    return [name for _, name in plan.starts]
