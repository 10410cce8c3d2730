"""How much is tried: the same examples in every run, so that a failure is one for everybody, and no clock."""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, settings

# Every run tries a part of what a law is to be tried with. `make campaign` tries all of it, and more.
SHARE = float(os.environ.get("SHARE_OF_EXAMPLES", "0.1"))
# How long work takes says something where nothing else is done: where others work too it takes three times as long.
TIMED = SHARE >= 1
ONLY_TIMED = pytest.mark.skipif(not TIMED, reason="how long it takes is for `make campaign`, on a quiet machine")


def rounds(number: int, least: int) -> int:
    """How often something is tried that is tried so often in campaigns, and never less often than the `least`."""
    return max(min(number, least), round(SHARE * number))


def examples(number: int, share: float = SHARE, least: int = 10) -> settings:
    """So many examples where all are tried, always the same ones, and never less than the `least`; how long one takes
    does not matter.
    """
    slow = (
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
        HealthCheck.large_base_example,
        HealthCheck.filter_too_much,
    )
    tried = max(min(number, least), round(share * number))
    return settings(max_examples=tried, derandomize=True, deadline=None, database=None, suppress_health_check=slow)
