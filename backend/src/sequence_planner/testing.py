"""For the tests of a station: the examples of its pipelines, each as a test of its own.

    from pathlib import Path

    import pytest

    from sequence_planner.testing import Example, examples

    @pytest.mark.parametrize("example", examples(Path(__file__).parent), ids=str)
    def test_pipelines(example: Example) -> None:
        example.check()

`sequence-planner check` carries out the same examples.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sequence_planner.pipelines.examples import PipelineExample
from sequence_planner.station import prepare_station

__all__ = ["Example", "examples"]


@dataclass(frozen=True)
class Example:
    """One example of a topic or flow, as it stands in the model."""

    of: PipelineExample

    def __str__(self) -> str:
        return str(self.of)

    def check(self) -> None:
        """Carry it out. Raises AssertionError saying what was expected, where, and what came."""
        if failures := self.of.failures():
            raise AssertionError("\n".join(map(str, failures)))


def examples(folder: Path) -> list[Example]:
    """All examples of the station in `folder`. Raises `ModelError` when it cannot be used."""
    return [Example(each) for each in prepare_station(folder).examples]
