"""Specifications that forbid nothing: most often something else was meant."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Automaton, Specification
from sequence_planner.checking.satisfiability import UndecidedError, can_be_asked, satisfying
from sequence_planner.checking.warning import ModelWarning, place


def check_specifications(automaton: Automaton) -> Iterator[ModelWarning]:
    """What was written as one specification, and of which no expansion forbids any state, reachable or not."""
    written: dict[str, list[Specification]] = defaultdict(list)
    for specification in automaton.specifications.values():
        written[without_arguments(specification.name.partition(": ")[0])].append(specification)
    for name, expansions in written.items():
        if not any(_forbids(automaton, each) for each in expansions):
            message = (
                f"`{name}` forbids nothing: no state, reachable or not, is as it says (see `show`). An ability without "
                "`executing` never executes, so it excludes nothing either"
            )
            yield ModelWarning(place(automaton, expansions[0].name), "forbids-nothing", message)


def _forbids(automaton: Automaton, specification: Specification) -> bool:
    """Whether it does, or is too hard a question."""
    forbidden = specification.forbidden
    try:
        return not can_be_asked(automaton, forbidden) or satisfying(automaton, forbidden) is not None
    except UndecidedError:
        return True
