"""The things that people have said of estimates while the station stands: confirmed, corrected, answered to a question.

It counts within that stop: from when it was said until an ability is started in automatic mode that reads or writes
the estimate, or the estimate has got another value. What is proposed meanwhile contradicts none of it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, Kind, State, reads, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.language.types import Value


def answered(
    automaton: Automaton,
    before: Mapping[str, Value],
    said: Iterable[str],
    state: State,
    taken_back: Collection[str] = (),
) -> dict[str, Value]:
    """The answers `before` and those that were `said` now, as they are in `state`, without what was `taken_back`."""
    estimates = {name for name in said if automaton.variables[name].kind is Kind.ESTIMATED}
    now = {name: value for name in sorted(estimates) if (value := state[name]) is not None}
    return {name: value for name, value in {**before, **now}.items() if name not in taken_back}


def still_to_rely_on(
    automaton: Automaton, answers: Mapping[str, Value], started: Iterable[Ability]
) -> Mapping[str, Value]:
    """The answers that none of the abilities `started` has to do with."""
    concerned = frozenset[str]().union(*(_concerned(automaton, ability) for ability in started))
    return {name: value for name, value in answers.items() if name not in concerned}


def _concerned(automaton: Automaton, ability: Ability) -> frozenset[str]:
    """The variables that decide whether the ability starts, and those that it writes."""
    actions = (*ability.start_actions, *ability.finish_actions)
    acted = {name for action in actions for name in (target(action), *reads(action))}
    return read_variables(automaton, (ability.enabled, ability.start_guard)) | acted
