"""Sequences in an editor: operations in them are found, renamed, completed and explained; they are parts themselves."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.editor.language.completion import complete
from sequence_planner.editor.language.hover import hover
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.language.service import check
from sequence_planner.editor.model_graph import graph
from sequence_planner.editor.symbols.definitions import Manner
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.loader import load_station
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.reader import EntryPath

from .stations import of_page, write

FILES = of_page("model.md")
OPERATIONS, MASTERS = "operations.yaml", "work_masters.yaml"
PARALLEL: EntryPath = ("one_part", "sequence", 1, "parallel")


@pytest.fixture
def lexicon(tmp_path: Path) -> Lexicon:
    write(FILES, tmp_path)
    return Lexicon.of(load_station(tmp_path))


@pytest.mark.parametrize(
    ("part", "used"),
    [
        ("operation:clamp_part", [("one_part", "sequence", 0)]),
        ("operation:inspect_side", [PARALLEL]),
        ("enumeration:side", [("inspect_side", "parameters", "where"), ("one_part", "sequence", 1, "for", "where")]),
        ("parameter:sequence:one_part.where", [PARALLEL]),
        ("sequence:one_part", [("clamped_part", "sequence")]),
    ],
)
def test_what_a_sequence_names_is_found(part: str, used: list[EntryPath]) -> None:
    found = usages(FILES, parse_part(part)).found
    assert [each.path for each in found if not each.declares and each.file in (OPERATIONS, MASTERS)] == used


@pytest.mark.parametrize(
    ("part", "new", "file", "line"),
    [
        ("operation:clamp_part", "hold_part", OPERATIONS, "    - hold_part\n"),
        ("operation:inspect_side", "look_at_side", OPERATIONS, "      parallel: look_at_side(where)\n"),
        ("parameter:sequence:one_part.where", "which", OPERATIONS, "      parallel: inspect_side(which)\n"),
        ("sequence:one_part", "whole_part", MASTERS, "  sequence: whole_part\n"),
    ],
)
def test_renaming_renames_it_there(part: str, new: str, file: str, line: str) -> None:
    text = renamed(FILES, parse_part(part), new, None)[file]
    assert text is not None
    assert line in text


def test_further_orders_are_renamed_too() -> None:
    orders = "  orders:\n    - for: {where: side}\n      parallel: {sequence: [clamp_part, inspect_side(where)]}\n"
    files = {**FILES, MASTERS: FILES[MASTERS].rstrip("\n") + "\n" + orders}
    for part, new, line in (
        ("operation:inspect_side", "look_at_side", "[clamp_part, look_at_side(where)]"),
        ("enumeration:side", "flank", "{where: flank}"),
        ("parameter:work_master:clamped_part.where", "which", "[clamp_part, inspect_side(which)]"),
    ):
        text = renamed(files, parse_part(part), new, None)[MASTERS]
        assert text is not None
        assert line in text


def test_an_operation_is_not_called_as_a_sequence_is() -> None:
    with pytest.raises(EditError, match="the sequence `one_part` is there already"):
        renamed(FILES, parse_part("operation:clamp_part"), "one_part", None)


def test_it_is_a_part_of_the_model() -> None:
    whole = graph(FILES)
    assert {
        tie.part.id for tie in whole.ties if tie.by == parse_part("sequence:one_part") and tie.manner is Manner.RUNS
    } == {
        "operation:clamp_part",
        "operation:inspect_side",
        "operation:release_part",
    }
    assert next(each.layer for each in whole.things if each.part.id == "sequence:one_part") == 3


@pytest.mark.parametrize(
    ("file", "path", "typed", "offered"),
    [
        (OPERATIONS, PARALLEL, "insp", "inspect_side(where)"),
        (OPERATIONS, ("one_part", "sequence", 0), "cl", "clamp_part"),
        (OPERATIONS, ("one_part", "sequence", 1, "for", "where"), "si", "side"),
        (OPERATIONS, ("other", "alternative", 0), "one", "one_part"),
        (MASTERS, ("clamped_part", "sequence"), "one", "one_part"),
        (MASTERS, ("new", "sequence", 0), "rel", "release_part"),
        (MASTERS, ("clamped_part", "orders", 0, "sequence", 1), "rel", "release_part"),
        (MASTERS, ("clamped_part", "orders", 0, "for", "where"), "si", "side"),
    ],
)
def test_its_operations_are_completed(lexicon: Lexicon, file: str, path: EntryPath, typed: str, offered: str) -> None:
    field = lexicon.field(file, path)
    assert field is not None
    assert offered in [option.insert for option in complete(lexicon, field, typed, len(typed)).options]


@pytest.mark.parametrize(
    ("path", "text", "part", "names"),
    [
        (PARALLEL, "inspect_side(where)", "operation:inspect_side", ("inspect_side(left)", "inspect_side(right)")),
        (("one_part", "sequence", 0), "clamp_part", "operation:clamp_part", ("clamp_part",)),
        (("other", "sequence", 0), "one_part", "sequence:one_part", ("one_part",)),
    ],
)
def test_its_operations_are_explained(
    lexicon: Lexicon, path: EntryPath, text: str, part: str, names: tuple[str, ...]
) -> None:
    field = lexicon.field(OPERATIONS, path)
    assert field is not None
    found = hover(lexicon, field, text, 3)
    assert found is not None
    assert (found.part, found.names) == (part, names)


@pytest.mark.parametrize(
    ("path", "text", "message"),
    [
        (PARALLEL, "inspect_side(where)", None),
        (
            PARALLEL,
            "inspect_sde(where)",
            "there is no operation `inspect_sde(left)`; did you mean `inspect_side(left)`?",
        ),
        (("one_part", "sequence", 0), "one_part", "sequences stand in each other in a circle: one_part → one_part"),
    ],
)
def test_what_is_wrong_is_said_while_it_is_written(
    lexicon: Lexicon, path: EntryPath, text: str, message: str | None
) -> None:
    field = lexicon.field(OPERATIONS, path)
    assert field is not None
    assert next((each.message for each in check(lexicon, field, text)), None) == message
