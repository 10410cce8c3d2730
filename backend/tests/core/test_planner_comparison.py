"""All engines beside exhaustive search: a sample of what `campaigns/planning.py` compares."""

from __future__ import annotations

from collections import Counter

from .planner_comparison import compare_engines


def test_no_engine_disagrees_with_exhaustive_search() -> None:
    met = sum((compare_engines(f"problems.2.{number}") for number in range(60)), Counter[str]())
    assert met["with a plan"] > 15
    assert met["pdr, minimal: proofs"] == met["without a plan"] > 15
    assert met["bmc, minimal: plans"] == met["breadth-first, minimal: plans"] == met["with a plan"]
