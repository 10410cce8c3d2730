"""Specifications that forbid nothing: most often something else was meant."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Automaton, Specification
from sequence_planner.checking.satisfiability import UndecidedError, can_be_asked, satisfying
from sequence_planner.checking.warning import ModelWarning, place

_FILE = "specifications.yaml"  # has a place where it is there and holds nothing


def check_specifications(automaton: Automaton) -> Iterator[ModelWarning]:
    """A file of specifications without any, and those of which no expansion forbids any state, reachable or not."""
    if not automaton.specifications and _FILE in automaton.places:
        message = "there is no specification here, so nothing is forbidden: write one, or delete the file"
        yield ModelWarning(automaton.places[_FILE], "no-specification", message)
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
