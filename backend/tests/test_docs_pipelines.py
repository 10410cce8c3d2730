"""What the page about pipelines shows is tried: its station loads, its examples hold, and every key is described."""

from __future__ import annotations

import re

import pytest

from sequence_planner.model.documents import (
    ActionDocument,
    ExampleDocument,
    ExampleStepDocument,
    FlowDocument,
    ServiceDocument,
)
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.stages.map import TableRowDocument
from sequence_planner.model.stages.registry import KINDS, StageDocument
from sequence_planner.model.stages.timing import BoundsDocument, EveryDocument
from sequence_planner.testing import Example, examples
from support.places import DOCS

TEXT = (DOCS / "pipelines.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```\w+ (\S+)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> list[Example]:
    """The examples of the page's station."""
    folder = tmp_path_factory.mktemp("station")
    for name, content in BLOCKS:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    return examples(folder)


def test_the_examples_of_the_page_hold(made: list[Example]) -> None:
    assert len(made) == 6
    for example in made:
        example.check()


@pytest.mark.parametrize(
    "part",
    [
        ServiceDocument,
        ActionDocument,
        FlowDocument,
        ExampleDocument,
        ExampleStepDocument,
        StageDocument,
        BoundsDocument,
        EveryDocument,
        TableRowDocument,
        *(kind for kind in KINDS.values() if not kind.is_bare),
    ],
    ids=lambda part: part.__name__,
)
def test_every_key_is_described(part: type[DocumentPart]) -> None:
    for name, field in part.model_fields.items():
        key = field.alias or name
        assert re.search(rf"[`{{ ,]{key}[`:,}} ]", TEXT), f"{key} of {part.__name__} is not described"
