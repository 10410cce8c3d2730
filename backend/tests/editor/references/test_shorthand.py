"""What is written for short is found and renamed wherever it is named."""

from __future__ import annotations

import pytest

from sequence_planner.editor.model_graph import Standing, graph
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.paths import EditError

from ..shorthand import SHORTHAND

ARM = "resources/arm.yaml"


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        ("set:ends", {"station.yaml": 3, ARM: 4, "operations.yaml": 1}),
        ("set:free", {"station.yaml": 2, ARM: 2}),
        ("relation:near", {"station.yaml": 1, ARM: 1, "specifications.yaml": 1}),
        ("map:grip_for", {"station.yaml": 1, ARM: 2}),
        ("parameter:arm.grip.slips.it", {ARM: 4}),
        ("set:arm.sides", {ARM: 12, "specifications.yaml": 1}),
        ("set:arm.lone", {ARM: 3, "specifications.yaml": 1}),
        ("relation:arm.across", {ARM: 2}),
        ("predicate:is_done", {"station.yaml": 2, ARM: 1, "operations.yaml": 2}),
        ("predicate:arm.is_at", {ARM: 4, "operations.yaml": 1}),
        ("parameter:is_done.which", {"station.yaml": 5}),
        ("value:spot.home", {"station.yaml": 5, "operations.yaml": 1}),  # also where it is a `pose`
        ("value:part.p2", {"station.yaml": 2, ARM: 1}),
        ("value:state.empty", {"station.yaml": 3, ARM: 1}),
        ("word:station.yaml:predicates.all_tight#0.p", {"station.yaml": 2}),
        ("variable:chosen", {"station.yaml": 3, ARM: 2}),
    ],
)
def test_where_it_is_named(part: str, expected: dict[str, int]) -> None:
    found = usages(SHORTHAND, parse_part(part)).found
    assert {file: sum(each.file == file for each in found) for file in {each.file for each in found}} == expected
    assert sum(each.declares for each in found) == 1


@pytest.mark.parametrize(
    ("part", "new", "message"),
    [
        ("word:station.yaml:predicates.all_tight#0.p", "goal", "the word `goal` would hide the variable `goal`"),
        ("word:station.yaml:predicates.all_tight#0.p", "tight", "would hide the value `state.tight`"),
        ("word:resources/arm.yaml:abilities.grip.executing#0.p", "q", "cannot be called `q`"),
        ("variable:goal", "p", "the word `p` would hide the variable `p`"),
        ("value:spot.home", "nowhere", "the value `pose.nowhere` is one of `pose` already"),
        ("value:pose.nowhere", "home", "the value `spot.home` is one of `pose` already"),
        ("set:free", "part", "the enumeration `part` is there already"),
        ("relation:near", "goal", "the variable `goal` is there already"),
        ("predicate:arm.is_at", "move", "the ability `arm.move` is there already"),
        ("map:grip_for", "next", "`next` is a word of quantifiers and orders"),
        ("word:station.yaml:rest#4.p", "q", "is declared nowhere"),
        (
            "parameter:arm.grip.slips.it",
            "held",
            "the parameter `arm.grip.slips.held` would hide the variable `arm.held`",
        ),
        ("parameter:arm.grip.slips.it", "bare", "would hide the value `grip.bare`"),
        ("parameter:arm.grip.slips.it", "one", "cannot be called `one`"),
        ("parameter:arm.grip.one", "it", "cannot be called `it`"),
    ],
)
def test_what_is_refused(part: str, new: str, message: str) -> None:
    with pytest.raises(EditError) as error:
        renamed(SHORTHAND, parse_part(part), new)
    assert message in str(error.value)


def test_a_word_is_renamed_in_its_expression_alone() -> None:
    new = renamed(SHORTHAND, parse_part("word:station.yaml:predicates.all_tight#0.p"), "each")
    before = "all p in part: bolts[p] == tight"
    assert new == {"station.yaml": SHORTHAND["station.yaml"].replace(before, "all each in part: bolts[each] == tight")}


def test_the_word_of_an_effect_is_renamed_in_it_alone() -> None:
    new = renamed(SHORTHAND, parse_part("parameter:arm.grip.slips.it"), "size")
    before = '{for: {it: grip}, when: "held == it and it != bare and grip_for[one] == it"'
    after = '{for: {size: grip}, when: "held == size and size != bare and grip_for[one] == size"'
    assert new == {ARM: SHORTHAND[ARM].replace(before, after)}


@pytest.mark.parametrize(("part", "new"), [("effect:arm.grip.slips", "falls"), ("ability:arm.grip", "hold")])
def test_it_stays_with_its_effect_and_that_with_its_ability(part: str, new: str) -> None:
    name = part.rpartition(".")[2]
    written = SHORTHAND[ARM].replace(f"  {name}:\n", f"  {new}:\n")
    assert renamed(SHORTHAND, parse_part(part), new) == {ARM: written}


def test_titles_follow_what_they_are_of() -> None:
    said = "titles: {tight: firm}, title: {en: 'bolt {where}'}, phrase: '{where} is {value}'"
    written = SHORTHAND["station.yaml"].replace("initial: empty}", f"initial: empty, {said}}}")
    files = {**SHORTHAND, "station.yaml": written}
    value = renamed(files, parse_part("value:state.tight"), "fast")
    assert said.replace("tight", "fast") in str(value["station.yaml"])
    parameter = renamed(files, parse_part("parameter:bolts.where"), "spot_of")
    assert said.replace("{where}", "{spot_of}") in str(parameter["station.yaml"])


def test_all_of_it_is_in_the_graph() -> None:
    found = graph(SHORTHAND)
    assert [thing.part.id for thing in found.things if thing.standing is Standing.MISSING] == []
    kinds = {thing.part.kind for thing in found.things}
    assert {"set", "relation", "map", "predicate"} <= kinds
    assert "word" not in kinds
    used = {(str(tie.by and tie.by.id), tie.part.id) for tie in found.ties}
    assert ("predicate:all_tight", "variable:bolts") in used
    assert ("ability:arm.move", "relation:near") in used
    assert ("alarm:stuck", "predicate:all_tight") in used
    assert ("set:work", "set:free") in used


def test_the_tables_of_stages_are_renamed_with_the_maps_and_relations_that_they_name() -> None:
    files = {
        "station.yaml": (
            "name: tables\nenumerations: {mode: [off, on]}\nmaps:\n"
            "  code_of: {from: mode, to: 0..3, values: {off: 0, on: 2}}\n"
            "relations:\n  same: {between: [mode, mode], pairs: [[off, off], [on, on]]}\n"
        ),
        ARM: (
            "topics:\n  /command:\n    type: arm_msgs/msg/Command\n    direction: out\n    pipeline:\n"
            "      - map: {field: code, variable: wanted, values: code_of}\n"
            "      - table: {fields: [wanted, last], variables: [calm], rows: [{when: same, gives: [true]}]}\n"
            "output: {wanted: {type: mode}, last: {type: mode}}\n"
        ),
    }
    for part, new in (("map:code_of", "number_of"), ("relation:same", "as_before")):
        old = part.partition(":")[2]
        assert len(usages(files, parse_part(part)).found) == 2
        assert renamed(files, parse_part(part), new) == {name: text.replace(old, new) for name, text in files.items()}
