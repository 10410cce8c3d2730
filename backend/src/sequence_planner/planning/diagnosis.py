"""Diagnosis of unsolvable planning problems: minimal reasons, and minimal corrections."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from enum import StrEnum
from functools import cached_property
from itertools import combinations, product
from typing import Final

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.heuristic.relaxation import Permission, Relaxation, counted_on, unreached
from sequence_planner.planning.heuristic.search import HeuristicSearch
from sequence_planner.planning.heuristic.unreachable import Relaxing
from sequence_planner.planning.operation_decomposition import OperationByOperation
from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.pdr.proof_clauses import asserted, is_met, satisfies
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import CertificateError, Circumstances, Contract, Goal, Plan, Proof
from sequence_planner.planning.validation.acceptance import Acceptance, tightened
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.texts.message import Item, Message, message

# What is soon known of a question: that there is a plan, or that there is none. Nobody need look for a proof then.

_MOST_POSITIONS = 100  # of a search: most plans that are there are found from fewer


class ReadyAnswers:
    """Answers about one automaton under one supervisor, as far as that takes little time."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._acceptance = Acceptance(automaton, supervisor)
        self._relaxing = Relaxing(automaton, supervisor)

    def answer(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan, which has been replayed, or a proof that there is none, or neither. Raises `SpentError`."""
        excluded = self._relaxing.solve(task, budget)
        if excluded.proof is not None:
            return excluded
        plan = self._by_operations.solve(task, budget).plan
        budget.require()
        if plan is None:
            ticks = self._search.ticks(task, budget, _MOST_POSITIONS)
            plan = None if ticks is None else Plan(ticks, minimal_ticks=False, minimal_starts=False)
        return Finding(plan if plan is not None and self._acceptance.accepts(task, plan) else None)

    @cached_property
    def _by_operations(self) -> OperationByOperation:
        return OperationByOperation(self._automaton, self._supervisor)

    @cached_property
    def _search(self) -> HeuristicSearch:
        return HeuristicSearch(self._automaton, self._supervisor)


# What would bring a plan back: the fewest values of estimated variables, resources, or abilities out of service, that
# need be different.

MOST_CHANGES = 2
MOST_FOUND = 5
_NOTHING_TO_DO = Plan((), minimal_ticks=True, minimal_starts=True)


class CorrectedValue(Immutable):
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

    changes: tuple[CorrectedValue, ...]
    plan: Plan


def corrections(
    automaton: Automaton,
    supervisor: Supervisor,
    task: PlanningTask,
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
        self, automaton: Automaton, supervisor: Supervisor, task: PlanningTask, budget: Budget, most_changes: int
    ) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._task = replace(task, contract=Contract.FAST)
        self._budget = budget
        self._most_changes = most_changes
        self._engine = Reachability(automaton, supervisor)
        self._ready = ReadyAnswers(automaton, supervisor)
        self._acceptance = Acceptance(automaton, supervisor)
        self._refuted: list[tuple[PlanningTask, Proof]] = []

    def found(self, most: int) -> Iterator[Correction]:
        """Those of the fewest changes."""
        restating: list[tuple[CorrectedValue, ...]] = []
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

    def _safe(self, size: int) -> Iterator[tuple[tuple[CorrectedValue, ...], PlanningTask]]:
        """All sets of so many changes that lead into a safe state, with what is left to do. Raises `SpentError`."""
        for changes in self._candidates(size):
            self._budget.require()
            task = self._changed(changes)
            if self._supervisor.safe.includes(task.state):
                yield changes, task

    def _candidates(self, size: int) -> Iterator[tuple[CorrectedValue, ...]]:
        """All sets of so many changes."""
        for subjects in combinations(self._options().values(), size):
            yield from product(*subjects)

    def _options(self) -> Mapping[str, tuple[CorrectedValue, ...]]:
        """The changes of each variable, resource and ability."""
        state = self._task.state
        options: dict[str, tuple[CorrectedValue, ...]] = {}
        for name in self._automaton.names(Kind.ESTIMATED):
            if state[name] is not None:
                domain = self._automaton.variables[name].type.domain
                options[name] = tuple(CorrectedValue(name, value) for value in domain if value != state[name])
        for resource in sorted(self._task.circumstances.offline):
            options[f"resource {resource}"] = (CorrectedValue(resource, None),)
        for ability in sorted(self._task.circumstances.barred):
            options[f"ability {ability}"] = (CorrectedValue(ability, None, ability=True),)
        return options

    def _plan(self, task: PlanningTask) -> Plan | None:
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

    def _changed(self, changes: tuple[CorrectedValue, ...]) -> PlanningTask:
        values = {change.name: change.value for change in changes if change.value is not None}
        state = synchronise(self._automaton, {**self._task.state, **values})
        back = {change.name for change in changes if change.value is None and not change.ability}
        served = {change.name for change in changes if change.ability}
        circumstances = self._task.circumstances
        circumstances = replace(
            circumstances, offline=circumstances.offline - back, barred=circumstances.barred - served
        )
        return replace(self._task, state=state, goals=missing(self._task.goals, state), circumstances=circumstances)


def _covers(refuted: PlanningTask, proof: Proof, task: PlanningTask) -> bool:
    """Return whether the proof for `refuted` is one for `task` too: no more may happen, and its invariant holds at
    first.
    """
    return (
        refuted.goals == task.goals
        and refuted.circumstances.offline <= task.circumstances.offline
        and refuted.circumstances.barred <= task.circumstances.barred
        and satisfies(asserted(task.state, task.goals), proof)
    )


# What the delete relaxation excludes whatever the values of most variables are: soon known, and often all it takes.


def relaxed_proof(
    automaton: Automaton, task: PlanningTask, fixed: Collection[str], supervisor: Supervisor | None = None
) -> Proof | None:
    """That the goals cannot be reached together from any state that has the values of the variables `fixed`.

    None where the relaxation does not tell. A variable that is awaited is none of those that may have other values.
    """
    first: dict[str, set[Value | None]] = {name: {value} for name, value in task.state.items()}
    for name, variable in automaton.variables.items():
        if name not in fixed and task.state[name] is not None:
            first[name] = set(variable.type.domain)
    permission = None if supervisor is None else Permission(supervisor)
    relaxed = Relaxation(automaton, first, counted_on(automaton, task.circumstances), permission)
    if all(relaxed.may(goal.predicate) for goal in task.goals):
        return None
    return unreached(automaton, relaxed)


# Why there is no plan: few circumstances that exclude every plan together, each of which does its part.
#
# What excludes plans is taken away piece by piece. A piece is needed if there is a plan without it (deletion filter,
# Chinneck and Dravnieks 1991); since taking away only ever allows more, one pass over all pieces is enough. Only where
# values are unknown does it not, and passes go on until one takes nothing away.

# The supervisor of the specifications with these names, and of no others.
SupervisorFor = Callable[[frozenset[str]], Supervisor]


class MemberKind(StrEnum):
    """The kind of a member of a reason."""

    VALUE = "value"  # of a variable, in the state to plan from
    SPECIFICATION = "specification"
    AVOID = "avoid"  # a condition to be avoided, as it prints
    OFFLINE = "offline"  # a resource
    BARRED = "barred"  # an ability that is out of service
    LOCAL = "local"  # the formula of a goal
    GOAL = "goal"


class Member(Immutable):
    """One of the circumstances that exclude every plan together; a `value` of None is awaited."""

    part: MemberKind
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


def explain(automaton: Automaton, supervisor_for: SupervisorFor, task: PlanningTask, budget: Budget) -> Reason | None:
    """A reason why the goals of `task` cannot be reached; None when they can, or nothing is proven in time.

    Flags follow the variables and are no members. When the budget is spent, the reason is what has been proven so far.
    """
    return _Explanation(automaton, supervisor_for, budget).of(task)


class _Situation(Immutable):
    """The part that is still as it was: a task, the specifications, and the variables with their values."""

    task: PlanningTask
    specifications: frozenset[str]
    fixed: frozenset[str]

    def members(self, automaton: Automaton) -> Iterator[Member]:
        """Yield what is still as it was; what the user would rather not hear of comes first."""
        circumstances = self.task.circumstances
        for name in automaton.variables:
            if name in self.fixed:
                yield Member(MemberKind.VALUE, name, self.task.state[name])
        for name in sorted(self.specifications):
            yield Member(MemberKind.SPECIFICATION, name)
        for condition in circumstances.avoid:
            yield Member(MemberKind.AVOID, print_expression(condition))
        for name in sorted(circumstances.offline):
            yield Member(MemberKind.OFFLINE, name)
        for name in sorted(circumstances.barred):
            yield Member(MemberKind.BARRED, name)
        for goal in self.task.goals:
            if goal.local != TRUE:
                yield Member(MemberKind.LOCAL, goal.name)
        for goal in self.task.goals:
            yield Member(MemberKind.GOAL, goal.name)

    def without(self, member: Member) -> _Situation:
        """The situation in which that is different."""
        task, circumstances, name = self.task, self.task.circumstances, member.name
        match member.part:
            case MemberKind.VALUE:
                return replace(self, fixed=self.fixed - {name})
            case MemberKind.SPECIFICATION:
                return replace(self, specifications=self.specifications - {name})
            case MemberKind.AVOID:
                kept = tuple(each for each in circumstances.avoid if print_expression(each) != name)
                return replace(self, task=replace(task, circumstances=replace(circumstances, avoid=kept)))
            case MemberKind.OFFLINE:
                fewer = circumstances.offline - {name}
                return replace(self, task=replace(task, circumstances=replace(circumstances, offline=fewer)))
            case MemberKind.BARRED:
                fewer = circumstances.barred - {name}
                return replace(self, task=replace(task, circumstances=replace(circumstances, barred=fewer)))
            case MemberKind.LOCAL:
                goals = tuple(_undemanding(goal) if goal.name == name else goal for goal in task.goals)
                return replace(self, task=replace(task, goals=goals))
            case MemberKind.GOAL:
                return replace(self, task=replace(task, goals=tuple(g for g in task.goals if g.name != name)))


class _Explanation:
    def __init__(self, automaton: Automaton, supervisor_for: SupervisorFor, budget: Budget) -> None:
        self._automaton = automaton
        self._supervisor_for = supervisor_for
        self._budget = budget
        self._engines: dict[frozenset[str], Reachability] = {}
        self._ready: dict[frozenset[str], ReadyAnswers] = {}
        self._certain = True  # that there is a plan wherever nothing has been proven, in the last pass

    def of(self, task: PlanningTask) -> Reason | None:
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

    def _monotone(self, task: PlanningTask) -> bool:
        """Return whether one pass is enough. A value that is awaited is none of those that a free variable may have."""
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
                if member.part is MemberKind.SPECIFICATION or not fewer.task.goals or _is_awaited(member):
                    continue
                eased = relaxed_proof(automaton, fewer.task, fewer.fixed, supervisor)
                if eased is not None:
                    here, proof = fewer, eased
            with suppress(CertificateError):  # flags that no value decides are not told apart where some is awaited
                return here, self._engine(names).checked(here.task, self._budget, self._free(here), proof)
        return None

    def _has_plan(self, situation: _Situation, without: Member) -> bool:
        """Return whether a plan is soon found without a member, with nothing else different: then it is needed."""
        automaton, task = self._automaton, situation.task
        if not task.goals or _is_awaited(without) or any(task.state[name] is None for name in self._free(situation)):
            return False  # one that is awaited, and free, is to have any value but to be awaited still
        names = situation.specifications
        if names not in self._ready:
            self._ready[names] = ReadyAnswers(automaton, self._supervisor_for(names))
        states: list[State] = [task.state]
        if without.part is MemberKind.VALUE:
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
    """Return whether it is a variable that has no value yet."""
    return member.part is MemberKind.VALUE and member.value is None


def _undemanding(goal: Goal) -> Goal:
    return replace(goal, local=TRUE, at=0)


# What is said when there is no plan at all: why, and what would bring one back.

_SHARE = 0.6  # of the time, for the reason; corrections have the rest


class DiagnosisRequest(Immutable):
    """A question why no run reaches all of `goals` from `state`, until `deadline` seconds have passed."""

    state: State
    goals: Goals
    circumstances: Circumstances
    deadline: float = 20.0

    @property
    def task(self) -> PlanningTask:
        """The task that cannot be done: goals that are met already take no part in it."""
        return PlanningTask(self.state, missing(self.goals, self.state), self.circumstances)


class Diagnosis(Immutable):
    """A `reason`, if one was found in time, and corrections of the fewest changes."""

    reason: Reason | None
    corrections: tuple[Correction, ...]


def diagnose(
    automaton: Automaton, supervisor: Supervisor, supervisor_for: SupervisorFor, task: PlanningTask, budget: Budget
) -> Diagnosis:
    """Find out why the goals of `task` cannot be reached, as far as the budget lets it be found."""
    reason = explain(automaton, supervisor_for, task, budget.part(_SHARE))
    return Diagnosis(reason, () if reason is None else corrections(automaton, supervisor, task, budget))


class WrittenNames:
    """The names of members and changes: those of the model, as its files have them."""

    def variable(self, name: str) -> Item:
        """Return what a variable is called."""
        return name

    def so(self, name: str, value: Value, written: str) -> Item:
        """Say that a variable has a value, which is `written` so."""
        return written

    def call_member(self, kind: MemberKind, name: str) -> Item:
        """Return what something of this kind is called that is no variable."""
        return name


WRITTEN: Final = WrittenNames()


def member_text(member: Member, out_of_service: Collection[str] = (), names: WrittenNames = WRITTEN) -> Message:
    """A member of a reason, in `names`; resources can be offline because they are `out_of_service`."""
    if member.part is MemberKind.VALUE:
        if member.value is None:
            return message("member.unknown", name=names.variable(member.name))
        written = f"{member.name} is {print_value(member.value)}"
        return message("member.so", so=names.so(member.name, member.value, written))
    name = names.call_member(member.part, member.name)
    match member.part:
        case MemberKind.SPECIFICATION:
            return message("member.specification", name=name)
        case MemberKind.AVOID:
            return message("member.avoid", name=name)
        case MemberKind.OFFLINE if member.name not in out_of_service:
            return message("member.offline", name=name)
        case MemberKind.OFFLINE | MemberKind.BARRED:
            return message("member.out-of-service", name=name)
        case MemberKind.LOCAL:
            return message("member.local", name=name)
        case MemberKind.GOAL:
            return message("member.goal", name=name)


def correction_text(
    correction: Correction, out_of_service: Collection[str] = (), names: WrittenNames = WRITTEN
) -> Message:
    """Changes that would help, in `names`; resources can be `out_of_service`."""
    return message("list", items=[_change_text(change, out_of_service, names) for change in correction.changes])


def _change_text(change: CorrectedValue, out_of_service: Collection[str], names: WrittenNames) -> Message:
    if change.value is not None:
        written = f"{change.name} := {print_value(change.value)}"
        return message("correction.so", so=names.so(change.name, change.value, written))
    name = names.call_member(MemberKind.BARRED if change.ability else MemberKind.OFFLINE, change.name)
    returns = change.ability or change.name in out_of_service
    return message("correction.in-service" if returns else "correction.online", name=name)


# Why there is no plan from any of several initial states: a reason for each, as few as are found to be enough.

DiagnoseFrom = Callable[[State, Budget], Diagnosis]


class FromThese(Immutable):
    """The reason why there is no plan from any of `states`, of which the `diagnosis` is of the first."""

    states: tuple[State, ...]
    diagnosis: Diagnosis


def why_from_each(
    states: Sequence[State], goals: Goals, diagnose_from: DiagnoseFrom, budget: Budget
) -> Iterator[FromThese]:
    """Tell why none of `states` leads to `goals`; those that no reason is found for in time come last, together.

    A reason holds for every state that agrees with it, and so for those of the others that do.
    """
    left, unexplained = list(states), list[State]()
    while left:
        first = left[0]
        diagnosis = diagnose_from(first, budget.part(1 / len(left)))
        reason = diagnosis.reason
        if reason is None:
            unexplained.append(left.pop(0))
            continue
        same = [state for state in left if state is first or holds_for(reason, state, goals)]
        left = [state for state in left if all(state is not other for other in same)]
        yield FromThese(tuple(same), diagnosis)
    if unexplained:
        yield FromThese(tuple(unexplained), Diagnosis(None, ()))


def holds_for(reason: Reason, state: State, goals: Goals) -> bool:
    """Return whether `reason`, found for another state, excludes every plan from `state` too."""
    wanted = {goal.name for goal in missing(goals, state)}
    return all(
        state[member.name] == member.value if member.part is MemberKind.VALUE else member.name in wanted
        for member in reason.members
        if member.part in (MemberKind.VALUE, MemberKind.GOAL)
    )
