"""How long an operation has been active: from when the station could begin with it."""

from __future__ import annotations

from sequence_planner.controller.features.plan import Operations
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.forecast import Forecast
from support.simulated import Rig


def test_the_time_of_what_is_active_before_production_is_started_begins_with_that() -> None:
    rig = Rig()
    operations = Operations(rig.execution, Forecast(rig.execution))

    def run(seconds: float) -> dict[str, float]:
        """Since when which operations are active."""
        end = rig.now + seconds
        while rig.now < end:
            rig.run(rig.step)
            for outcome in rig.ticks:
                operations.after_tick(outcome, Timestamp(rig.now, rig.now))
            rig.ticks.clear()
        views = operations.view_part(Timestamp(rig.now, rig.now))["operations"]
        assert isinstance(views, dict)
        return {name: each.active_since for name, each in views.items() if each.active}

    before = run(5)
    assert before, "nothing is active before production is started"
    assert max(before.values()) < rig.now - 3
    rig.start_production()
    started = rig.now
    first = run(rig.step)
    assert {name: since >= started for name, since in first.items()} == dict.fromkeys(first, True)
    later = run(2)
    assert {name: later[name] for name in first if name in later} == {
        name: first[name] for name in first if name in later
    }
