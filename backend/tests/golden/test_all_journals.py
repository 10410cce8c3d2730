"""All that were recorded are replayed, and each goes on from its last snapshot as it went on."""

from __future__ import annotations

import pytest

from golden.journals import names, records, replayed
from sequence_planner.execution.record.codec import SNAPSHOT


@pytest.mark.parametrize("name", names())
def test_it_is_replayed_bit_for_bit(name: str) -> None:
    run = records(name)
    assert replayed(run) is None
    for place, record in enumerate(run):
        if record.kind == SNAPSHOT:
            assert replayed(run[place:]) is None
