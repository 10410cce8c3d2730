"""Forces: what can be forced to which values, that none leads out of the safe states, and that each ends by itself."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import pytest

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.approvals import ForceVariable, ReleaseForce
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.features.commissioning.forces import Forces
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import Value
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.people import EVA
from support.places import WORKED_EXAMPLE

NOW = Timestamp(1000.0, 10.0)
WHY = "the sensor is not wired yet"


@cache
def prepared() -> tuple[Automaton, Supervisor]:
    automaton = prepare_station(WORKED_EXAMPLE).automaton
    return automaton, synthesise(automaton)


class Forced:
    """The worked example, with what its devices measure, and somebody who forces variables."""

    def __init__(self, estimates: Mapping[str, Value] | None = None, **measured: Value | None) -> None:
        automaton, supervisor = prepared()
        self.execution = Executor(automaton, supervisor)
        initial = automaton.initial_valuation
        self.measured = {name: initial[name] for name in automaton.names(Kind.MEASURED)}
        self.measured |= {name.replace("__", "."): value for name, value in measured.items()}
        self.forcing = Forces(self.execution)
        self.execution.tick(self.measured, NOW)
        if estimates is not None:
            self.execution.correct(estimates, "Eva", WHY, NOW)

    def force(self, name: str, value: Value, seconds: float = 60) -> None:
        carry_out(self.forcing, ForceVariable(actor=EVA, reason=WHY, name=name, value=value, seconds=seconds), NOW)

    def release(self, name: str) -> None:
        carry_out(self.forcing, ReleaseForce(actor=EVA, name=name), NOW)

    def after(self, seconds: float) -> Mapping[str, Value | None]:
        """The state after a tick that much later."""
        self.execution.tick(self.measured, Timestamp(NOW.epoch + seconds, NOW.monotonic + seconds))
        return self.execution.state

    def refused(self, name: str, value: Value) -> CommandRefused:
        """How that is refused; nothing has changed then."""
        before = (self.execution.state, self.execution.conduct, self.execution.revision)
        with pytest.raises(CommandRefused) as found:
            self.force(name, value)
        assert (self.execution.state, self.execution.conduct, self.execution.revision) == before
        return found.value


def test_a_forced_measurement_is_what_it_is_forced_to_until_its_time_is_over() -> None:
    bench = Forced()
    bench.force("nutrunner.programmed_torque_reached", value=True, seconds=60)
    assert bench.after(0)["nutrunner.programmed_torque_reached"] is True
    assert bench.after(59)["nutrunner.programmed_torque_reached"] is True
    assert bench.after(61)["nutrunner.programmed_torque_reached"] is False
    assert not bench.execution.conduct.forces


def test_it_can_be_let_go_before() -> None:
    bench = Forced()
    bench.force("nutrunner.programmed_torque_reached", value=True)
    bench.release("nutrunner.programmed_torque_reached")
    assert bench.after(1)["nutrunner.programmed_torque_reached"] is False
    bench.release("nutrunner.programmed_torque_reached")  # which is so already


def test_who_has_forced_what_until_when_and_why_is_known() -> None:
    bench = Forced()
    bench.force("operator.acknowledged", value=True, seconds=30)
    force = bench.execution.conduct.forces["operator.acknowledged"]
    assert (force.by, force.why, force.until, force.real) == ("Eva", WHY, Timestamp(1030.0, 40.0), False)


@pytest.mark.parametrize(
    ("name", "value", "slug", "status"),
    [
        ("bolts", "placed", "not-forceable", 422),  # an estimate is corrected
        ("robot.poss", "home", "unknown-variable", 404),
        ("robot.pose", "hom", "not-in-domain", 422),
        ("robot.pose", True, "not-in-domain", 422),
        ("operator.acknowledged", 1, "not-in-domain", 422),  # 1 is not true
        ("operator.acknowledged", "true", "not-in-domain", 422),
    ],
)
def test_what_cannot_be_forced(name: str, value: Value, slug: str, status: int) -> None:
    refused = Forced().refused(name, value)
    assert (refused.slug, refused.status) == (slug, status)


def test_a_refusal_says_what_to_do() -> None:
    assert Forced().refused("robot.poss", "home").detail.endswith("did you mean `robot.pose`?")
    assert "{home, above, bolt_pair, unknown}" in Forced().refused("robot.pose", "hom").detail
    assert "correct it instead" in Forced().refused("bolts", "placed").detail


@pytest.mark.parametrize("name", ["robot.pose", "robot.target_pose"])
def test_nobody_can_force_the_robot_onto_placed_bolts(name: str) -> None:
    bench = Forced({"bolts": "placed"})
    refused = bench.refused(name, "bolt_pair")
    assert (refused.slug, refused.status) == ("force-unsafe", 409)
    [specification] = prepared()[0].specifications.values()
    assert specification.title in refused.detail
    bench.force(name, "above")


def test_nobody_can_force_what_leads_there_without_any_start() -> None:
    """A robot that is commanded to the bolts gets there: that nothing is violated yet is not enough."""
    bench = Forced({"bolts": "empty"}, robot__pose="above")
    bench.force("operator.task", value=True)
    refused = bench.refused("robot.target_pose", "bolt_pair")
    assert refused.slug == "force-unsafe"
    assert "From there" in refused.detail


def test_a_measurement_that_is_awaited_can_be_forced() -> None:
    """For this forces are there: a device that is not wired yet."""
    bench = Forced(robot__pose=None, nutrunner__programmed_torque_reached=None)
    bench.force("robot.pose", "home")
    assert bench.after(1)["robot.pose"] == "home"
    assert bench.after(61)["robot.pose"] is None


def test_outside_the_safe_states_an_output_is_forced_only_back_into_them() -> None:
    bench = Forced({"bolts": "placed"}, robot__pose="bolt_pair")
    assert not bench.execution.safe
    assert bench.refused("operator.task", value=True).slug == "force-unsafe"
    bench.force("operator.acknowledged", value=True)  # it was violated before, and nothing moves
    bench.force("robot.pose", "home")
    bench.after(1)
    assert bench.execution.safe
