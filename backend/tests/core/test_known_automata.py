"""Automata of any size whose numbers of states are known: philosophers and transfer lines."""

from __future__ import annotations

import json

import pytest

from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.model.efa_document import read_plain
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant

from .explicit_plain import ExplicitPlain, Key
from .known_automata import Document, philosophers, transfer_lines


def supervision_of(document: Document) -> Supervision:
    automaton = plain_automaton(read_plain(json.dumps(document), "known.efa.json"))
    return Supervision(Plant(automaton, tuple(automaton.variables)))


def numbers(supervision: Supervision) -> tuple[int, int]:
    """Of states reachable without the supervisor, and with it."""
    without, under = (supervision.plant.diagrams.count(supervision.reachable(kind)) for kind in (False, True))
    return without, under


@pytest.mark.parametrize("number", [4, 5, 20, 60])
def test_philosophers_lose_the_two_states_without_a_way_on(number: int) -> None:
    supervision = supervision_of(philosophers(number))
    assert numbers(supervision) == (3**number, 3**number - 2)
    assert supervision.possible


@pytest.mark.parametrize("number", [1, 2, 12])
def test_transfer_lines(number: int) -> None:
    supervision = supervision_of(transfer_lines(number))
    assert numbers(supervision) == (120 * 360 ** (number - 1), 28 * 45 ** (number - 1))
    assert supervision.possible


def test_twelve_transfer_lines_have_118_bits() -> None:
    plant = supervision_of(transfer_lines(12)).plant
    assert sum(map(len, plant.diagrams.bits.values())) == 118


@pytest.mark.parametrize("document", [philosophers(3), transfer_lines(1)], ids=lambda document: document["name"])
def test_the_states_are_those_of_the_definition(document: Document) -> None:
    supervision, explicit = supervision_of(document), ExplicitPlain({"forbidden": [], "invariant": "true"} | document)
    diagrams = supervision.plant.diagrams
    order = list(explicit.types)

    def members(states: Function) -> set[Key]:
        exported = diagrams.exported(states, diagrams.names)
        return {tuple(member[name] for name in order) for member in exported.members()}

    assert members(supervision.safe) == explicit.safe
    for supervised in (False, True):
        reached = members(supervision.reachable(supervised))
        assert reached == explicit.distances(explicit.initial, supervised).keys()
        assert len(reached) == numbers(supervision)[supervised]
