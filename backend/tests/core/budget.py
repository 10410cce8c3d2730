"""How much is tried: the same examples in every run, so that a failure is one for everybody."""

from __future__ import annotations

from hypothesis import HealthCheck, settings


def examples(number: int) -> settings:
    """So many examples, always the same ones; how long one takes does not matter."""
    slow = (
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
        HealthCheck.large_base_example,
        HealthCheck.filter_too_much,
    )
    return settings(max_examples=number, derandomize=True, deadline=None, database=None, suppress_health_check=slow)
