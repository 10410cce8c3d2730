"""Localization abstraction for PDR: visible variables, start orders, and concretization of abstract plans."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Set
from functools import cached_property
from itertools import combinations

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    State,
    VariableDeclaration,
    target,
)
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    supervised_start,
    synchronise,
)
from sequence_planner.automaton.transitions import transitions
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.substitution import rebuilt
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Assignment,
    Expression,
    Implies,
    Not,
    Or,
    Variable,
    conjunction,
    conjuncts,
    variables,
)
from sequence_planner.language.types import BOOLEAN, Type
from sequence_planner.planning.goals.pursuit import Goals, settled
from sequence_planner.planning.pdr.transition_relation import ChoiceStep, Relation
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.sat.flag_dependencies import FollowingFlags
from sequence_planner.planning.sat.start_order import Order, Sweep
from sequence_planner.process.budget import Budget

# The automaton seen through some of its variables: whatever it can do to these, what is seen can do as well.
#
# What is read of other variables has any value, decided anew in each tick by an *oracle* (localisation, Kurshan 1994):
# a variable for each place where it is read. So goals that cannot be reached in what is seen cannot be reached at all.

_ALL = StateSet((), ())


class Localised(Immutable):
    """The part that is seen, and for each oracle the variables it speaks for. States outside the safe set are not told
    apart.
    """

    automaton: Automaton
    supervisor: Supervisor
    oracles: Mapping[str, frozenset[str]]

    def state(self, state: State) -> State:
        """Return what is seen of `state`; oracles say anything."""
        return synchronise(self.automaton, {name: state.get(name, False) for name in self.automaton.types})

    def order(self, order: Iterable[Ability]) -> tuple[Ability, ...]:
        """The starts of `order` that write anything that is seen."""
        seen = (self.automaton.abilities.get(ability.name) for ability in order)
        return tuple(ability for ability in seen if ability is not None and ability.start_actions)


def localised(automaton: Automaton, supervisor: Supervisor, kept: frozenset[str]) -> Localised:
    """`automaton`, none of whose variables is unknown, seen through its variables `kept`."""
    return _Localiser(automaton, supervisor, kept).localised()


def localisable(automaton: Automaton, state: State, goals: Goals) -> bool:
    """Return whether questions about runs from `state` can be answered so.

    Unknown values decide too much, and formulas count the positions of runs, also those at which nothing seen happens.
    """
    known = None not in state.values() and synchronise(automaton, state) == dict(state)
    return known and all(goal.local == TRUE for goal in goals)


class _Localiser:
    def __init__(self, automaton: Automaton, supervisor: Supervisor, kept: frozenset[str]) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._kept = kept
        hidden = {flag.name for flag in FollowingFlags(automaton).flags(automaton.variables.keys() - kept)}
        self._flags = frozenset(flag.name for flag in automaton.flags if flag.name not in hidden)
        self._seen = kept | self._flags
        self._declared: dict[str, VariableDeclaration] = {}
        self._oracles: dict[str, frozenset[str]] = {}
        self._disputed = dict(_disputed(automaton, kept))

    def localised(self) -> Localised:
        automaton = self._automaton
        abilities = {ability.name: ability for ability in self._abilities()}
        guards = {
            name: _projected(guard, self._kept) for name, guard in self._supervisor.guards.items() if name in abilities
        }
        enabled = {ability.flag("enabled") for ability in abilities.values()} - self._flags
        flags = (
            *(flag for flag in automaton.flags if flag.name in self._flags),
            *(Flag(name, TRUE) for name in sorted(enabled)),
        )
        seen = replace(
            automaton,
            abilities=abilities,
            effects=tuple(self._effects()),
            flags=flags,
            variables={n: v for n, v in automaton.variables.items() if n in self._kept} | self._declared,
        )
        return Localised(seen, Supervisor(_ALL, guards), self._oracles)

    def _effects(self) -> Iterator[Effect]:
        for effect in self._automaton.effects:
            if not effect.fault and self._relevant(effect.actions):
                place = _Place(self, inlined=True)
                yield replace(effect, guard=place.predicate(effect.guard), actions=place.actions(effect.actions))

    def _abilities(self) -> Iterator[Ability]:
        for ability in self._automaton.abilities.values():
            starts, finishes = self._relevant(ability.start_actions), self._relevant(ability.finish_actions)
            if not starts and (not finishes or ability.finish_guard is None):
                continue
            start, end = _Place(self, inlined=True), _Place(self, inlined=False)
            guard = conjunction(ability.enabled, ability.start_guard)
            if ability.flag("enabled") in self._flags:
                enabled, guard = ability.enabled, ability.start_guard
            else:
                enabled = TRUE
            guard = start.predicate(guard)
            if hidden := frozenset(self._supervisor.guards.get(ability.name, _ALL).names) - self._kept:
                guard = conjunction(guard, self.oracle(BOOLEAN, hidden))
            finish = ability.finish_guard if finishes else None
            if finish is not None:
                finish = end.predicate(finish)
                if hidden := self._disputed.get(ability.name, frozenset()):
                    finish = conjunction(finish, self.oracle(BOOLEAN, hidden))
            yield replace(
                ability,
                enabled=enabled,
                start_guard=guard,
                start_actions=start.actions(ability.start_actions),
                finish_guard=finish,
                finish_actions=end.actions(ability.finish_actions) if finish is not None else (),
            )

    def _relevant(self, actions: tuple[Assignment, ...]) -> bool:
        return any(target(action) in self._kept for action in actions)

    def visible(self, expression: Expression) -> bool:
        """Return whether nothing is read that is not seen."""
        return self._seen.issuperset(variables(expression))

    def kept(self, name: str) -> bool:
        """Return whether the variable is seen."""
        return name in self._kept

    def inlined(self, name: str) -> Expression | None:
        """The predicate of a flag."""
        return self._automaton.flag_predicates.get(name)

    def hidden(self, expression: Expression) -> frozenset[str]:
        """The variables it reads that are not seen."""
        return read_variables(self._automaton, (expression,)) - self._kept

    def oracle(self, type_: Type, hidden: frozenset[str]) -> Variable:
        """A new one, which speaks for the variables `hidden`."""
        name = f"oracle.{len(self._oracles)}"
        self._oracles[name] = hidden
        self._declared[name] = VariableDeclaration(name, type_, Kind.MEASURED, type_.domain[0], None)
        return Variable(name, type_)


class _Place:
    """A moment of the tick at which one transition reads the state: what it reads twice has one value.

    Flags may be `inlined` where they are those of the state that is read.
    """

    def __init__(self, localiser: _Localiser, inlined: bool) -> None:
        self._localiser = localiser
        self._inlined = inlined
        self._values: dict[Expression, Variable] = {}

    def predicate(self, expression: Expression) -> Expression:
        """The predicate, where each part that reads what is not seen is what an oracle says."""
        localiser = self._localiser
        if localiser.visible(expression):
            return expression
        match expression:
            case Not() | And() | Or() | Implies():
                return rebuilt(expression, self.predicate)
            case Variable(name) if self._inlined and (predicate := localiser.inlined(name)) is not None:
                return self.predicate(predicate)
            case _:
                return self._oracle(expression, BOOLEAN)

    def actions(self, actions: tuple[Assignment, ...]) -> tuple[Assignment, ...]:
        """Those that write what is seen."""
        return tuple(self._action(action) for action in actions if self._localiser.kept(target(action)))

    def _action(self, action: Assignment) -> Assignment:
        value, written = action.value, action.target
        assert isinstance(written, Variable)
        if not self._localiser.visible(value):
            value = self.predicate(value) if written.type == BOOLEAN else self._oracle(value, written.type)
        condition = None if action.condition is None else self.predicate(action.condition)
        return Assignment(written, value, condition)

    def _oracle(self, expression: Expression, type_: Type) -> Variable:
        if expression not in self._values:
            self._values[expression] = self._localiser.oracle(type_, self._localiser.hidden(expression))
        return self._values[expression]


def _projected(states: StateSet, kept: frozenset[str]) -> StateSet:
    """Return what `states` allow for some value of the variables that are not kept."""
    hidden = frozenset(states.names) - kept
    return _complement(_complement(states).for_all(hidden)) if hidden else states


def _complement(states: StateSet) -> StateSet:
    other = {NOTHING: EVERYTHING, EVERYTHING: NOTHING}
    nodes = tuple((axis, tuple(other.get(child, child) for child in children)) for axis, children in states.nodes)
    return replace(states, nodes=nodes, root=other.get(states.root, states.root))


def _disputed(automaton: Automaton, kept: frozenset[str]) -> Iterator[tuple[str, frozenset[str]]]:
    """The abilities whose finish another one's can refuse over variables that are not kept, with all these."""
    writers: dict[str, set[str]] = {}
    for ability in automaton.abilities.values():
        if ability.finish_guard is not None:
            for action in ability.finish_actions:
                writers.setdefault(target(action), set()).add(ability.name)
    found: dict[str, set[str]] = {}
    for name, abilities in writers.items():
        if name not in kept:
            for pair in combinations(sorted(abilities), 2):
                if _may_differ(automaton, name, pair):
                    for each in pair:
                        found.setdefault(each, set()).add(name)
    return ((ability, frozenset(names)) for ability, names in found.items())


def _may_differ(automaton: Automaton, name: str, pair: tuple[str, ...]) -> bool:
    one, other = ({a.value for a in automaton.abilities[each].finish_actions if target(a) == name} for each in pair)
    return one != other or len(one) > 1


# Orders of starts for ticks of an automaton, and of what is seen of it.

# Abilities up to which one order for all of them is soon found.
_FEW = 80

# Places in an order above which it is worth to look for a shorter one, if abilities are repeated.
_MANY = 80


class Orders:
    """Orders of which every order is a part that can make a difference to a task; what is found out is kept.

    If one is `given`, it is such an order.
    """

    def __init__(self, automaton: Automaton, supervisor: Supervisor, given: Order | None = None) -> None:
        self._given = given
        self._sweep = Sweep(automaton, supervisor)
        self._automaton = automaton
        self._whole: dict[tuple[bool, frozenset[str]], Order] = {}

    def whole(self, task: PlanningTask, budget: Budget) -> Order:
        """For the automaton. Raises `SpentError`."""
        if self._given is not None:
            return self._given
        told_apart = _told_apart(self._sweep, self._automaton, task)
        restart = task.circumstances.restart
        if (restart, told_apart) not in self._whole:
            self._whole[restart, told_apart] = self._sweep.complete(budget, told_apart, restart)
        return self._whole[restart, told_apart]

    def part(self, seen: Localised, task: PlanningTask, budget: Budget) -> Order:
        """For what is seen of it; what is not seen can make starts exclude each other. Raises `SpentError`."""
        if self._given is None and len(self._automaton.abilities) > _FEW:
            sweep = Sweep(seen.automaton, seen.supervisor)
            told_apart = _told_apart(sweep, seen.automaton, task)
            own = seen.order(sweep.complete(budget, told_apart, task.circumstances.restart))
            if len(own) <= max(_MANY, len(seen.automaton.abilities)):
                return own
        return seen.order(self.whole(task, budget))


def _told_apart(sweep: Sweep, automaton: Automaton, task: PlanningTask) -> frozenset[str]:
    """The abilities between whose starts formulas and conditions to be avoided look at the state."""
    demands = (*task.circumstances.avoid, *(goal.local for goal in task.goals))
    return sweep.writers(read_variables(automaton, demands))


# Ways to the goals, found through some of the variables, tried on the reference tick.

Names = frozenset[str]
_NOTHING: Names = frozenset()


class _Failed(Exception):
    """It fails, and these variables, which are not seen, may tell why."""

    def __init__(self, names: Iterable[str]) -> None:
        super().__init__()
        self.names = frozenset(names)


class ConcretePlan(Immutable):
    """Tries what is planned for `task` with sight of the variables `kept` alone; `oracles` spoke for the others."""

    automaton: Automaton
    supervisor: Supervisor
    task: PlanningTask
    kept: Names
    oracles: Mapping[str, Names]

    def missing(self, begin: State, run: Iterable[ChoiceStep], relation: Relation) -> Names | None:
        """None when it succeeds; else variables that matter where it fails first, if these can be told."""
        state, goals = begin, self.task.goals
        try:
            for step in run:
                if not relation.includes(step.cube, state):
                    return _NOTHING
                after = self._settled(state, step)
                left = settled(goals, after)
                if not left:
                    return _NOTHING if left is None else None
                state, goals = self._started(state, after, step), left
                if step.following is not None and not relation.includes(step.following.cube, state):
                    raise _Failed(name for oracle in step.oracles for name in self.oracles[oracle])
        except _Failed as failed:
            return failed.names - self.kept
        return _NOTHING

    def _settled(self, state: State, step: ChoiceStep) -> State:
        """The state after step 3 of the tick."""
        effects = [effect for effect in self.automaton.effects if effect.name in step.effects]
        for effect in effects:
            if effect_writes(effect, state) is None:
                raise _Failed(self._denied(effect.guard, state))
        sensed = apply_effects(state, effects)
        if sensed is None:
            raise _Failed(target(action) for effect in effects for action in effect.actions)
        return self._allowed(synchronise(self.automaton, finish(self.automaton, sensed).state))

    def _started(self, published: State, state: State, step: ChoiceStep) -> State:
        for name in step.starts:
            ability = self.automaton.abilities[name]
            after = supervised_start(self.automaton, self.supervisor, published, state, ability)
            if after is None:
                raise _Failed(self._kept_from(ability, state))
            state = self._allowed(after)
        return state

    def _kept_from(self, ability: Ability, state: State) -> Iterable[str]:
        """Return what may keep `ability` from its start."""
        guard = conjunction(ability.enabled, ability.start_guard)
        if not holds(guard, state):
            return self._denied(guard, state)
        allowed = self.supervisor.guards.get(ability.name, self.supervisor.safe)
        return allowed.names if not allowed.includes(state) else map(target, ability.start_actions)

    def _allowed(self, state: State) -> State:
        if any(evaluate(condition, state) is not False for condition in self.task.circumstances.avoid):
            raise _Failed(())
        return state

    def _denied(self, guard: Expression, state: State) -> Names:
        """The hidden variables of the first part of `guard` that fails and has any."""
        for part in conjuncts(guard):
            hidden = read_variables(self.automaton, (part,)) - self.kept
            if hidden and not holds(part, state):
                return hidden
        return _NOTHING


# What to look at: through which variables an automaton is seen first, and through which ones then.

# Values, of all variables together, that are better seen at once than little by little.
_FEW_VALUES = 80

# Variables up to which all are seen of which the supervisor speaks.
_FEW_SUPERVISED = 12


class VariableSelection:
    """Of one automaton under one supervisor."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor

    def first(self, asked: Iterable[Expression]) -> Names:
        """Return what the questions `asked` read, with what the supervisor speaks of besides; where it matters, that
        decides.

        Where it says nothing, and there is little to see, all of it.
        """
        read = read_variables(self._automaton, asked)
        with_supervised = self._closed(read, self._supervised)
        if 0 < len(with_supervised - read) <= _FEW_SUPERVISED:
            return with_supervised
        return self._all_if_few(read)

    def further(self, kept: Names, needed: Names) -> Names:
        """More than `kept`: all that can matter if that is little, else of what is `needed` first the supervised."""
        everything = self._all_if_few(kept)
        return everything | needed if everything != kept else kept | (needed & self._supervised or needed)

    def _all_if_few(self, kept: Names) -> Names:
        cone = self._closed(kept, self._automaton.variables.keys())
        values = sum(len(self._automaton.variables[name].type.domain) for name in cone)
        return cone if values <= _FEW_VALUES else kept

    def _closed(self, names: Names, among: Set[str]) -> Names:
        """`names` with those `among` which decide how they are written, and those which decide these, and so on."""
        found = set(names)
        pending = list(names)
        while pending:
            new = (self._deciding[pending.pop()] & among) - found
            found |= new
            pending += new
        return frozenset(found)

    @cached_property
    def _supervised(self) -> Names:
        """The variables by which the supervisor keeps starts from being taken."""
        names = (guard.names for guard in self._supervisor.guards.values())
        return frozenset[str]().union(*names) & self._automaton.variables.keys()

    @cached_property
    def _deciding(self) -> dict[str, set[str]]:
        """For each variable those that whatever writes it reads, the supervisor included."""
        guards = {f"{name}.start": frozenset(guard.names) for name, guard in self._supervisor.guards.items()}
        deciding: dict[str, set[str]] = defaultdict(set)
        for transition in transitions(self._automaton):
            if not transition.fault:
                read = transition.reads | guards.get(transition.name, frozenset())
                for name in transition.writes:
                    deciding[name] |= read
        behind = {flag.name: read_variables(self._automaton, (flag.predicate,)) for flag in self._automaton.flags}
        for names in deciding.values():
            names.update(*(behind[name] for name in names & behind.keys()))
        return deciding
