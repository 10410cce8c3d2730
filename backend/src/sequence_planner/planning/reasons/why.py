"""Why there is no plan: few circumstances that exclude every plan together, each of which does its part.

What excludes plans is taken away piece by piece. A piece is needed if there is a plan without it (deletion filter,
Chinneck and Dravnieks 1991); since taking away only ever allows more, one pass over all pieces is enough. Only where
values are unknown does it not, and passes go on until one takes nothing away.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from enum import StrEnum

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import TRUE
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Task
from sequence_planner.planning.pdr.certificate import CertificateError
from sequence_planner.planning.pdr.engine import Reachability
from sequence_planner.planning.pdr.invariants import asserted, is_met
from sequence_planner.planning.plan import Goal, Proof
from sequence_planner.planning.reasons.ready_answers import ReadyAnswers
from sequence_planner.planning.reasons.relaxed_reason import relaxed_proof
from sequence_planner.planning.replaying.replay import missing

# The supervisor of the specifications with these names, and of no others.
SupervisorFor = Callable[[frozenset[str]], Supervisor]


class Part(StrEnum):
    """What a member of a reason is."""

    VALUE = "value"  # of a variable, in the state to plan from
    SPECIFICATION = "specification"
    AVOID = "avoid"  # a condition to be avoided, as it prints
    OFFLINE = "offline"  # a resource
    BARRED = "barred"  # an ability that is out of service
    LOCAL = "local"  # the formula of a goal
    GOAL = "goal"


class Member(Immutable):
    """One of the circumstances that exclude every plan together; a `value` of None is awaited."""

    part: Part
    name: str
    value: Value | None = None


class Reason(Immutable):
    """There is no plan as long as all `members` are as they are, whatever else is different: `proof` shows it.

    If it is `minimal`, there is a plan without any one of them: were the goal not asked for, its formula not demanded,
    the specification not given, the resource online, the ability in service, the condition not avoided, or some other
    value in place. All goals must hold after step 3 of some tick.
    """

    members: tuple[Member, ...]
    minimal: bool
    proof: Proof


def explain(automaton: Automaton, supervisor_for: SupervisorFor, task: Task, budget: Budget) -> Reason | None:
    """A reason why the goals of `task` cannot be reached; None when they can, or nothing is proven in time.

    Flags follow the variables and are no members. When the budget is spent, the reason is what has been proven so far.
    """
    return _Explanation(automaton, supervisor_for, budget).of(task)


class _Situation(Immutable):
    """What is still as it was: a task, the specifications, and the variables with their values."""

    task: Task
    specifications: frozenset[str]
    fixed: frozenset[str]

    def members(self, automaton: Automaton) -> Iterator[Member]:
        """What is still as it was; what the user would rather not hear of comes first."""
        circumstances = self.task.circumstances
        for name in automaton.variables:
            if name in self.fixed:
                yield Member(Part.VALUE, name, self.task.state[name])
        for name in sorted(self.specifications):
            yield Member(Part.SPECIFICATION, name)
        for condition in circumstances.avoid:
            yield Member(Part.AVOID, print_expression(condition))
        for name in sorted(circumstances.offline):
            yield Member(Part.OFFLINE, name)
        for name in sorted(circumstances.barred):
            yield Member(Part.BARRED, name)
        for goal in self.task.goals:
            if goal.local != TRUE:
                yield Member(Part.LOCAL, goal.name)
        for goal in self.task.goals:
            yield Member(Part.GOAL, goal.name)

    def without(self, member: Member) -> _Situation:
        """The situation in which that is different."""
        task, circumstances, name = self.task, self.task.circumstances, member.name
        match member.part:
            case Part.VALUE:
                return replace(self, fixed=self.fixed - {name})
            case Part.SPECIFICATION:
                return replace(self, specifications=self.specifications - {name})
            case Part.AVOID:
                kept = tuple(each for each in circumstances.avoid if print_expression(each) != name)
                return replace(self, task=replace(task, circumstances=replace(circumstances, avoid=kept)))
            case Part.OFFLINE:
                fewer = circumstances.offline - {name}
                return replace(self, task=replace(task, circumstances=replace(circumstances, offline=fewer)))
            case Part.BARRED:
                fewer = circumstances.barred - {name}
                return replace(self, task=replace(task, circumstances=replace(circumstances, barred=fewer)))
            case Part.LOCAL:
                goals = tuple(_undemanding(goal) if goal.name == name else goal for goal in task.goals)
                return replace(self, task=replace(task, goals=goals))
            case Part.GOAL:
                return replace(self, task=replace(task, goals=tuple(g for g in task.goals if g.name != name)))


class _Explanation:
    def __init__(self, automaton: Automaton, supervisor_for: SupervisorFor, budget: Budget) -> None:
        self._automaton = automaton
        self._supervisor_for = supervisor_for
        self._budget = budget
        self._engines: dict[frozenset[str], Reachability] = {}
        self._ready: dict[frozenset[str], ReadyAnswers] = {}
        self._certain = True  # that there is a plan wherever nothing has been proven, in the last pass

    def of(self, task: Task) -> Reason | None:
        automaton = self._automaton
        situation = _Situation(task, frozenset(automaton.specifications), frozenset(automaton.variables))
        try:
            proven = self._excluded(situation) or self._proven(situation)
        except SpentError:
            return None
        if proven is None:
            return None
        minimal = False
        with suppress(SpentError):
            while not minimal:
                before, self._certain = proven[0], True
                for member in tuple(before.members(automaton)):
                    if member not in tuple(proven[0].members(automaton)):
                        continue  # an earlier proof did without it
                    fewer = proven[0].without(member)
                    if not self._has_plan(fewer, member):
                        proven = self._proven(fewer) or proven
                minimal = self._monotone(task) or proven[0] == before
        situation, proof = proven
        return Reason(tuple(situation.members(automaton)), minimal and self._certain, proof)

    def _monotone(self, task: Task) -> bool:
        """Whether one pass is enough. A value that is awaited is none of those that a free variable may have."""
        return None not in task.state.values() and synchronise(self._automaton, task.state) == dict(task.state)

    def _excluded(self, situation: _Situation) -> tuple[_Situation, Proof] | None:
        """As much of the situation as it takes for the relaxation to exclude a plan; None if it does not.

        Best without any specification: to find out which of them matter takes synthesis, again and again.
        """
        automaton = self._automaton
        for names in (frozenset[str](), situation.specifications):
            supervisor = self._supervisor_for(names) if names else None
            here = replace(situation, specifications=names)
            proof = relaxed_proof(automaton, here.task, here.fixed, supervisor)
            if proof is None:
                continue
            for member in tuple(here.members(automaton)):
                self._budget.require()
                fewer = here.without(member)
                if member.part is Part.SPECIFICATION or not fewer.task.goals or _is_awaited(member):
                    continue
                eased = relaxed_proof(automaton, fewer.task, fewer.fixed, supervisor)
                if eased is not None:
                    here, proof = fewer, eased
            with suppress(CertificateError):  # flags that no value decides are not told apart where some is awaited
                return here, self._engine(names).checked(here.task, self._budget, self._free(here), proof)
        return None

    def _has_plan(self, situation: _Situation, without: Member) -> bool:
        """Whether a plan is soon found without a member, with nothing else different: then it is needed."""
        automaton, task = self._automaton, situation.task
        if not task.goals or _is_awaited(without) or any(task.state[name] is None for name in self._free(situation)):
            return False  # one that is awaited, and free, is to have any value but to be awaited still
        names = situation.specifications
        if names not in self._ready:
            self._ready[names] = ReadyAnswers(automaton, self._supervisor_for(names))
        states: list[State] = [task.state]
        if without.part is Part.VALUE:
            domain = automaton.variables[without.name].type.domain
            others = (value for value in domain if value != without.value)
            states = [synchronise(automaton, {**task.state, without.name: value}) for value in others]
        return any(
            self._ready[names].answer(replace(task, state=state), self._budget).plan is not None
            for state in states
            if missing(task.goals, state) == task.goals  # what holds already may not once the next tick looks
        )

    def _engine(self, names: frozenset[str]) -> Reachability:
        if names not in self._engines:
            self._engines[names] = Reachability(self._automaton, self._supervisor_for(names))
        return self._engines[names]

    def _proven(self, situation: _Situation) -> tuple[_Situation, Proof] | None:
        """As much of the situation as it takes for a proof that there is no plan; None if there is one."""
        if not situation.task.goals:
            return None
        engine, task = self._engine(situation.specifications), situation.task
        decision = engine.decide(task, self._budget, self._free(situation))
        if decision.proof is None:
            self._certain &= decision.certain
            return None
        eased = self._eased(situation, decision.proof)
        return eased, engine.checked(task, self._budget, self._free(eased), decision.proof)

    def _free(self, situation: _Situation) -> frozenset[str]:
        return frozenset(self._automaton.variables) - situation.fixed

    def _eased(self, situation: _Situation, proof: Proof) -> _Situation:
        """The same with all values free but those by which the invariant holds at the beginning.

        Values that are awaited stay: with others the invariant would have to be another one.
        """
        values = asserted(situation.task.state, situation.task.goals)
        kept = frozenset(name for name in situation.fixed if values[name] is None)
        for clause in proof.invariant:
            behind = [self._behind(literal.name) for literal in clause if is_met(literal, values)]
            certain = [names for names in behind if names <= situation.fixed]
            if not certain:
                return situation
            if not any(names <= kept for names in certain):
                kept |= certain[0]
        return replace(situation, fixed=kept)

    def _behind(self, name: str) -> frozenset[str]:
        """The variables that decide it; none decides how far goals have come."""
        predicates = self._automaton.flag_predicates
        if name in predicates:
            return read_variables(self._automaton, (predicates[name],))
        return frozenset({name} & self._automaton.variables.keys())


def _is_awaited(member: Member) -> bool:
    """Whether it is a variable that has no value yet."""
    return member.part is Part.VALUE and member.value is None


def _undemanding(goal: Goal) -> Goal:
    return replace(goal, local=TRUE, at=0)
