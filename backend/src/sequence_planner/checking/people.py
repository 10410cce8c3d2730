"""Tasks that nobody is ever asked for, and tasks of which a person could not tell which one is acknowledged."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import combinations

from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.checking.satisfiability import UndecidedError, can_be_asked, satisfying
from sequence_planner.checking.warning import ModelWarning, described, place
from sequence_planner.expressions.syntax import FALSE, conjunction, variables

MOST_REPORTED = 3  # pairs for each acknowledgement


def check_people(automaton: Automaton) -> Iterator[ModelWarning]:
    """Human abilities whose task is never open, and pairs with one acknowledgement that can be open at once."""
    yield from _never_open(automaton)
    sharing: dict[str, list[Ability]] = defaultdict(list)
    for ability in automaton.abilities.values():
        if ability.human is not None:
            sharing[ability.human.acknowledgement].append(ability)
    for acknowledgement, abilities in sharing.items():
        reported = 0
        for one, other in combinations(abilities, 2):
            both = conjunction(one.executing, other.executing)
            if reported == MOST_REPORTED or not can_be_asked(automaton, both):
                break
            try:
                state = satisfying(automaton, both)
            except UndecidedError:
                continue
            if state is None:
                continue
            reported += 1
            when = described(state, dict.fromkeys(variables(both)))
            message = (
                f"the tasks of `{one.name}` and `{other.name}` can be open at once ({when}), and `{acknowledgement}` "
                "acknowledges both: give each its own, or let `executing` tell which one is asked for"
            )
            yield ModelWarning(
                place(automaton, f"{other.name}.executing", other.name), "shared-acknowledgement", message
            )


def _never_open(automaton: Automaton) -> Iterator[ModelWarning]:
    for ability in automaton.abilities.values():
        if ability.human is not None and ability.executing == FALSE:
            message = (
                f"the task of `{ability.name}` is never open: a task is open while its ability executes, and this one "
                "never does. Write `executing`, such as that the request is there and the acknowledgement is not"
            )
            yield ModelWarning(place(automaton, f"{ability.name}.executing", ability.name), "task-never-open", message)
