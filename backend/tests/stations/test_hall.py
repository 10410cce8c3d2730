"""A short sample of the campaign: one engine under faults, with every node and the controller a process of its own."""

from __future__ import annotations

from stations.disturbing import assembled


def test_an_engine_is_assembled_under_faults_without_a_wrong_step() -> None:
    seen = assembled(150, "sample", speed=8, engines=1)
    assert seen["engine done"] == 1
    assert seen["bolt tightened"] >= 6
