"""One editor for the tests of a module, and stations for it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from support.editor import Editor
from support.places import MODELS


@pytest.fixture(scope="module")
def editor() -> Iterator[Editor]:
    with Editor() as editor:
        yield editor


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """A copy of the bolt tightening station."""
    folder = tmp_path / "bolt_tightening"
    shutil.copytree(MODELS / "bolt_tightening", folder)
    return folder


@pytest.fixture
def robots(tmp_path: Path) -> Path:
    """A copy of the station whose two robots are of one type."""
    folder = tmp_path / "robots_with_buffer"
    shutil.copytree(MODELS / "robots_with_buffer", folder)
    return folder
