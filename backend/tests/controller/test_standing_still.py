"""Devices that do nothing though nothing of them is overdue: they are noticed, and not counted on."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Timeouts
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.features.abilities import Abilities
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.places import BOLT_TIGHTENING

PLACES = EnumerationType(("home", "between", "work"))


def made() -> tuple[Executor, StallDetector]:
    """A cart that goes to where it was sent, within five seconds."""
    cart = automaton(
        {
            "go": Does(
                ("target := work",),
                "at == home",
                executing="at != target",
                finish="at == work",
                timeouts=Timeouts(finish=5),
            )
        },
        measured={"at": (PLACES, "home")},
        output={"target": (PLACES, "home")},
        effects={"go.arrives": ("at == between", ("at := target",))},
    )
    execution = Executor(cart, synthesise(cart))
    return execution, StallDetector(execution)


def tick(execution: Executor, at: Value | None, seconds: float) -> None:
    execution.tick({"at": at}, Timestamp(1000.0 + seconds, seconds))


def test_a_device_that_was_pushed_away_and_does_not_come_back_is_noticed() -> None:
    execution, still = made()
    execution.start_production()
    tick(execution, "home", 0.0)
    tick(execution, "between", 1.0)
    tick(execution, "between", 5.9)
    assert (still.late(5.9), still.devices(5.9)) == ({}, {})
    assert still.late(6.1).keys() == {"go.arrives"}
    assert list(still.devices(6.1).values()) == [{"at"}]
    tick(execution, "home", 6.2)
    tick(execution, "between", 6.3)
    assert still.late(11.0) == {}
    assert still.late(11.4).keys() == {"go.arrives"}


def test_it_is_an_alarm_that_says_what_the_device_says() -> None:
    execution, still = made()
    station = prepare_station(BOLT_TIGHTENING)
    alarms = Abilities(execution, Inputs(station.pipelines, station.registry), still, Consequences(execution))
    execution.start_production()
    tick(execution, "between", 1.0)
    assert not [cause for cause in alarms.causes(Timestamp(1005.0, 5.0)) if cause.key.startswith("still:")]
    (told,) = [cause for cause in alarms.causes(Timestamp(1006.1, 6.1)) if cause.key.startswith("still:")]
    assert "does not go on. It still reports: at == between" in str(told.text)


def test_what_is_not_heard_or_was_told_nothing_yet_is_not_waited_for() -> None:
    execution, still = made()
    tick(execution, "between", 0.0)
    tick(execution, "between", 50.0)
    assert still.late(50.0) == {}
    execution.start_production()
    tick(execution, "between", 51.0)
    assert still.late(55.9) == {}
    tick(execution, None, 55.9)
    assert still.late(100.0) == {}
    tick(execution, "between", 100.0)
    assert still.late(104.9) == {}
    assert still.late(105.1).keys() == {"go.arrives"}


def shared(takes: float = 0.5) -> tuple[Executor, StallDetector]:
    """A cart that has a minute for its way, and a gripper with five seconds, which feels what is where the cart is."""
    cart = automaton(
        {
            "go": Does(("target := work",), "at == home", executing="at != target", finish="at == work"),
            "grip": Does(("closed := true",), "felt", executing="closed and not shut", finish="closed and shut"),
        },
        measured={"at": (PLACES, "home"), "felt": (BOOLEAN, False), "shut": (BOOLEAN, False)},
        output={"target": (PLACES, "home"), "closed": (BOOLEAN, False)},
        effects={
            "arrives": ("at != target", ("at := target",)),
            "feels": ("at == work and not felt", ("felt := true",)),
            "loses": ("at != work and felt", ("felt := false",)),
            "shuts": ("closed and not shut", ("shut := true",)),
        },
    )
    of = {"go": "cart", "arrives": "cart", "at": "cart"}
    limits = {"go": Timeouts(finish=60), "grip": Timeouts(finish=5)}
    abilities = {
        name: replace(each, resource=of.get(name, "gripper"), timeouts=limits[name])
        for name, each in cart.abilities.items()
    }
    cart = replace(
        cart,
        resources={"cart": "Cart", "gripper": "Gripper"},
        abilities=abilities,
        effects=tuple(
            replace(each, resource=of.get(each.name, "gripper"), longest=takes if each.name == "arrives" else 0.5)
            for each in cart.effects
        ),
        variables={n: replace(each, resource=of.get(n, "gripper")) for n, each in cart.variables.items()},
    )
    execution = Executor(cart, synthesise(cart))
    return execution, StallDetector(execution)


def shared_tick(execution: Executor, at: Value, felt: bool, seconds: float) -> None:
    execution.tick({"at": at, "felt": felt, "shut": False}, Timestamp(1000.0 + seconds, seconds))


def test_the_device_is_to_blame_that_should_have_moved_first_however_much_time_it_had() -> None:
    """The cart says for ever that it is on its way; the gripper feels already what is at work."""
    execution, still = shared()
    execution.start_production()
    shared_tick(execution, "home", False, 0.0)
    execution.state = {**execution.state, "target": "work"}
    shared_tick(execution, "between", False, 1.0)
    shared_tick(execution, "between", True, 3.0)
    shared_tick(execution, "between", True, 7.9)
    assert still.late(7.9) == {}
    shared_tick(execution, "between", True, 8.1)
    assert still.late(8.1) == {"arrives": {"loses"}}
    assert still.stalled(8.1) == {"arrives", "loses"}
    assert still.explained_effects(8.1) == {"loses"}
    assert still.devices(8.1) == {"cart": {"at"}}
    assert still.explained(8.1) == {"gripper": (frozenset({"felt"}), frozenset({"cart"}))}


def test_a_device_that_is_late_by_itself_is_to_blame_itself() -> None:
    """The cart has arrived, and the gripper feels nothing; then the cart is sent away again, and is soon late too."""
    execution, still = shared()
    execution.start_production()
    execution.state = {**execution.state, "target": "work"}
    shared_tick(execution, "work", False, 0.0)
    shared_tick(execution, "work", False, 4.0)
    execution.state = {**execution.state, "target": "home"}
    shared_tick(execution, "work", False, 4.5)
    assert still.late(6.0) == {"feels": frozenset()}
    assert still.devices(6.0) == {"gripper": {"felt"}}


def test_a_device_that_takes_much_longer_than_it_ever_does_is_noticed_before_its_run_is_overdue() -> None:
    """The state is safe, the run may take a minute, and the way of the cart four seconds."""
    for takes, told in ((4.0, 12.0), (0.5, 10.0), (45.0, 90.0)):
        execution, still = shared(takes)
        execution.start_production()
        execution.state = {**execution.state, "target": "work"}
        shared_tick(execution, "between", False, 1.0)
        assert still.late(0.9 + told) == {}
        assert still.late(1.1 + told) == {"arrives": frozenset()}
        assert still.devices(1.1 + told) == {"cart": {"at"}}


def test_the_device_is_to_blame_that_does_not_say_what_another_one_has_brought_about() -> None:
    """The cart has arrived, by which the gripper that it carries is to feel something."""
    execution, _ = shared()
    effects = (replace(each, resource="cart") if each.name == "feels" else each for each in execution.automaton.effects)
    carrying = replace(execution.automaton, effects=tuple(effects))
    execution = Executor(carrying, synthesise(carrying))
    still, station = StallDetector(execution), prepare_station(BOLT_TIGHTENING)
    alarms = Abilities(execution, Inputs(station.pipelines, station.registry), still, Consequences(execution))
    execution.start_production()
    execution.state = {**execution.state, "target": "work"}
    shared_tick(execution, "work", False, 0.0)
    assert still.devices(9.9) == {}
    assert still.devices(10.1) == {"gripper": {"felt"}}
    (told,) = alarms.causes(Timestamp(1010.1, 10.1))
    assert told.text == "Gripper does not go on. It still reports: not felt"
    assert (told.key, told.action, told.resources) == (
        "still:gripper",
        "See what keeps Gripper from going on.",
        ("gripper",),
    )


def test_all_are_to_blame_who_do_not_say_what_has_come_about() -> None:
    execution, _ = shared()
    by_name = {each.name: each for each in execution.automaton.effects}
    arrives = replace(by_name["arrives"], actions=(*by_name["arrives"].actions, *by_name["feels"].actions))
    effects = (arrives, *(each for name, each in by_name.items() if name == "shuts"))
    together = replace(execution.automaton, effects=effects)
    execution = Executor(together, synthesise(together))
    still = StallDetector(execution)
    execution.start_production()
    execution.state = {**execution.state, "target": "work"}
    shared_tick(execution, "between", False, 0.0)
    assert still.devices(10.1) == {"cart": {"at"}, "gripper": {"felt"}}
    shared_tick(execution, "between", True, 10.2)
    assert still.devices(20.3) == {"cart": {"at"}}
