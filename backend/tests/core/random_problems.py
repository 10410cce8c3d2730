"""Random planning problems: a station with its supervisor, a state, and goals that random runs have reached.

Some goals have formulas for the way there, some resources are offline and some abilities barred, and some states are
to be avoided.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, replace

from sequence_planner.automaton.automaton import Automaton, Operation, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.language.syntax import (
    TRUE,
    And,
    BinaryTemporal,
    Comparison,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    UnaryTemporal,
    Variable,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Circumstances, goals_of
from sequence_planner.synthesis.supervisor import SynthesisError, synthesise

from .choices import Choices
from .explicit import outcomes
from .random_devices import device_station
from .random_expressions import atom, rare
from .random_stations import automaton, state_of

RESOURCES = ("cell", "robot", "tool")
_LONGEST_RUN = 6


@dataclass(frozen=True)
class Problem:
    """The operations of `automaton` are the goals to be reached from `state`."""

    automaton: Automaton
    supervisor: Supervisor
    state: State
    circumstances: Circumstances

    @property
    def goals(self) -> Goals:
        """The goals of all operations."""
        return goals_of(self.automaton, self.automaton.operations)


def problem(choices: Choices, unknown: bool = False, demanding: bool = False) -> Problem:
    """A problem, with `unknown` from a state with unknown values, with `demanding` with formulas and circumstances."""
    station = device_station(choices) if choices.chance(2) else automaton(choices)
    station, supervisor = with_supervisor(_shared_out(choices, station) if demanding else station)
    state = state_of(choices, station, unknown)
    for _ in range(5):
        if not supervisor.safe.includes(state):
            state = state_of(choices, station, unknown)
    operations: dict[str, Operation] = {}
    for number in range(max(choices.number(1, 3), len(station.operations))):
        name = f"g{number}"  # such as those whose activity is read
        goal = _goal(choices, station, state, _run(choices, station, supervisor, state))
        local = formula(choices, station) if demanding and choices.chance(2) else None
        operations[name] = Operation(name, name, TRUE, goal, choices.number(0, 2), local)
    circumstances = _circumstances(choices, station) if demanding else Circumstances()
    return Problem(replace(station, operations=operations), supervisor, state, circumstances)


def formula(choices: Choices, station: Automaton, depth: int = 2) -> Expression:
    """A formula over runs, such as engineers write them, and now and then any."""
    scope = [Variable(name, type_) for name, type_ in station.types.items()]
    if depth <= 0:
        return atom(choices, scope)
    operator = choices.pick(("G", "F", "X", "N", "U", "R", "W", "and", "or", "not", "implies"))
    first = formula(choices, station, depth - choices.number(1, 2))
    if operator in ("G", "F", "X", "N"):
        return UnaryTemporal(operator, Not(first) if choices.chance(3) else first)
    if operator == "not":
        return Not(first)
    second = formula(choices, station, depth - choices.number(1, 2))
    if operator == "implies":
        return Implies(first, second)
    if operator in ("and", "or"):
        return And((first, second)) if operator == "and" else Or((first, second))
    return BinaryTemporal(operator, first, second)


def _shared_out(choices: Choices, station: Automaton) -> Automaton:
    """The abilities and effects shared out to several resources, and some abilities for restart only."""
    abilities = {
        name: replace(ability, resource=choices.pick(RESOURCES), restart=choices.chance(4))
        for name, ability in station.abilities.items()
    }
    effects = tuple(replace(effect, resource=choices.pick(RESOURCES)) for effect in station.effects)
    return replace(station, resources={name: name for name in RESOURCES}, abilities=abilities, effects=effects)


def _circumstances(choices: Choices, station: Automaton) -> Circumstances:
    scope = [Variable(name, type_) for name, type_ in station.types.items()]
    return Circumstances(
        frozenset(choices.different(RESOURCES[1:], 0, 1)),
        choices.chance(2),
        tuple(rare(choices, scope) for _ in range(choices.number(0, 1))),
        frozenset(choices.different(list(station.abilities), 0, 1)),
    )


def with_supervisor(station: Automaton) -> tuple[Automaton, Supervisor]:
    """The station with its supervisor; what cannot be met is left out."""
    for each in (station, replace(station, rest=None), replace(station, specifications={})):
        with contextlib.suppress(SynthesisError):
            return each, synthesise(each)
    free = replace(station, rest=None, specifications={})
    return free, synthesise(free)


def _run(choices: Choices, station: Automaton, supervisor: Supervisor, state: State) -> State:
    """The state after step 3 in which a random run from `state` ends."""
    helpful = [effect for effect in station.effects if not effect.fault]
    settled = after = state
    for _ in range(choices.number(2, _LONGEST_RUN)):
        before = after
        settled = after = choices.pick(outcomes(station, before, helpful)[::-1])
        for ability in choices.different(list(station.abilities.values()), 1, 4):
            started = supervised_start(station, supervisor, before, after, ability)
            if started is not None and not ability.restart:
                after = started
    return settled


def _goal(choices: Choices, station: Automaton, start: State, end: State) -> Expression:
    """What holds in `end`, and not in `start` if they differ; or now and then anything."""
    scope = [Variable(name, type_) for name, type_ in station.types.items()]
    if choices.chance(5):
        return rare(choices, scope)
    changed = [variable for variable in scope if end[variable.name] not in (None, start[variable.name])]
    known = [variable for variable in scope if end[variable.name] is not None]
    chosen = [*choices.different(changed, 1, 2), *choices.different(known, 0, 2)]
    return And((TRUE, TRUE, *(_equals(variable, end[variable.name]) for variable in chosen)))


def _equals(variable: Variable, value: Value | None) -> Expression:
    assert value is not None
    return Comparison("==", variable, Constant(value))
