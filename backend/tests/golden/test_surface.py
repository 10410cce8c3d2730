"""Names on which others rely are as they were written down."""

from __future__ import annotations

import pytest

from golden.surface import PARTS, TEXTS


@pytest.mark.parametrize("part", PARTS)
def test_it_is_as_it_was(part: str) -> None:
    now, then = PARTS[part](), (TEXTS / part).read_text(encoding="utf-8")
    others = f"tests/golden/surface/{part}: others rely on these names. If all of them are to learn of it: make golden"
    assert now.splitlines() == then.splitlines(), others
    assert now == then, others


def test_nothing_else_was_written_down() -> None:
    assert {file.name for file in TEXTS.iterdir()} == PARTS.keys()
