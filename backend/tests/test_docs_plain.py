"""What the page about plain automata shows is tried."""

from __future__ import annotations

import re

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.model.efa_document import PlainDocument, TransitionDocument, read_plain
from sequence_planner.model.fields import DocumentPart
from sequence_planner.planning.efa_planner import plan_transitions
from sequence_planner.planning.problem import goals_of
from sequence_planner.synthesis.supervisor import synthesise
from support.places import DOCS

TEXT = (DOCS / "plain-automata.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def automaton() -> Automaton:
    [text] = re.findall(r"^```json two-users.efa.json\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    return plain_automaton(read_plain(text, "two-users.efa.json"))


def test_the_supervisor_holds_back_what_the_page_says(automaton: Automaton) -> None:
    supervisor = synthesise(automaton)
    assert set(supervisor.guards) == {"u1_grabs", "u2_grabs"}
    has = {**automaton.initial_valuation, "u1": "has", "free": False, "uses": 1}
    assert not supervisor.guards["u2_grabs"].includes(has)
    assert supervisor.guards["u2_grabs"].includes({**has, "u1": "idle"})


def test_its_goals_are_planned(automaton: Automaton) -> None:
    supervisor = synthesise(automaton)
    once, thrice = (
        plan_transitions(automaton, supervisor, goals_of(automaton, (goal,))).events for goal in ("goal_1", "goal_2")
    )
    assert once == ("u1_asks", "u1_grabs")
    assert sum(event.endswith("grabs") for event in thrice) == 3


@pytest.mark.parametrize("part", [PlainDocument, TransitionDocument], ids=lambda part: part.__name__)
def test_every_key_is_described(part: type[DocumentPart]) -> None:
    for name, field in part.model_fields.items():
        assert f"| `{field.alias or name}` |" in TEXT, f"{name} of {part.__name__} is not described"
