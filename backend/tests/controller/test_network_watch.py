"""What the ROS graph says about the station's topics."""

from __future__ import annotations

from dataclasses import replace

from controller.mixing import FLUSH, FLUSH_TYPE, STIR, STIR_TYPE, mixer
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.ros.transport import NetworkEndpoint, ServiceEnd
from support.cell import COMMAND, COMMAND_TYPE, STATE, STATE_TYPE, cell

REPORTS = NetworkEndpoint(
    topic=STATE,
    type_name=STATE_TYPE,
    direction="publisher",
    own=False,
    type_hash=None,
    node="/devices",
    reliable=True,
    transient_local=False,
)
OBEYS = replace(REPORTS, topic=COMMAND, type_name=COMMAND_TYPE, direction="subscriber")


def watch() -> NetworkWatch:
    station = cell()[0]
    made = NetworkWatch(station.pipelines, station.registry)
    made.commands = True
    return made


def test_peers_are_those_that_can_be_understood() -> None:
    network = watch()
    mistyped = replace(REPORTS, type_name="std_msgs/msg/String")
    stale = replace(REPORTS, type_hash="RIHS01_0")
    known = replace(REPORTS, type_hash=cell()[0].registry.type_hash(STATE_TYPE))
    own = replace(REPORTS, own=True)
    network.look([REPORTS, known, mistyped, own, OBEYS, replace(OBEYS, direction="publisher", own=True)])
    assert network.peers == {STATE: 2, COMMAND: 1}
    assert "as std_msgs/msg/String, and the station's model says" in network.troubles[STATE]
    network.look([stale])
    assert "theirs is RIHS01_0, ours is RIHS01_" in network.troubles[STATE]
    assert network.peers[STATE] == 0


def test_another_commander_is_said_beside_other_trouble() -> None:
    network = watch()
    rival = replace(OBEYS, direction="publisher", node=None)
    mistyped = replace(OBEYS, type_name="std_msgs/msg/String")
    network.look([rival, mistyped])
    assert network.rivals == {COMMAND: f"another node also publishes {COMMAND}: two would command the same device"}
    assert COMMAND in network.troubles
    network.look([])
    assert not network.rivals


def test_publishers_that_have_all_gone_are_told_once() -> None:
    network = watch()
    assert network.look([]) == frozenset(), "none was ever there"
    assert network.look([REPORTS, REPORTS, OBEYS]) == frozenset()
    assert network.look([REPORTS]) == frozenset()
    assert network.look([]) == {STATE}
    assert network.look([]) == frozenset()


def test_devices_are_those_of_one_node_when_nobody_else_speaks_or_obeys() -> None:
    network = watch()
    assert network.strangers([REPORTS], "/devices") == [f"/devices is not yet on {COMMAND}"]
    assert network.strangers([REPORTS, OBEYS], "/devices") == []
    listens = replace(REPORTS, direction="subscriber", node="/recorder")
    assert network.strangers([REPORTS, OBEYS, listens], "/devices") == []
    for other in (replace(REPORTS, node="/real"), replace(OBEYS, node="/real")):
        assert network.strangers([REPORTS, OBEYS, other], "/devices") == [f"/real is on {other.topic}"]
    nameless = replace(REPORTS, node=None)
    assert network.strangers([nameless, OBEYS], "/devices") == [
        f"/devices is not yet on {STATE}",
        f"another node is on {STATE}",
    ]


def test_a_server_that_writes_calls_otherwise_is_told_until_it_has_gone() -> None:
    station = mixer()[0]
    network = NetworkWatch(station.pipelines, station.registry)
    flush = ServiceEnd(FLUSH, FLUSH_TYPE, "server", False, "/tank", "eProsima Fast DDS", understood=False)
    stir = replace(
        flush, service=f"{STIR}/_action/send_goal", type_name=f"{STIR_TYPE}_SendGoal", node=None, vendor=None
    )
    harmless = (
        replace(flush, understood=True),
        replace(flush, own=True),
        replace(flush, role="client"),
        replace(flush, service="/else"),
    )
    network.look([], harmless)
    assert not network.troubles
    network.look([], [*harmless, flush, stir])
    says = "whose calls are written otherwise than this station's: nothing is asked of it"
    assert network.troubles == {
        f"{FLUSH} response": f"/tank serves {FLUSH} on eProsima Fast DDS (rmw_fastrtps_cpp), {says}",
        f"{STIR} status": f"another node carries out {STIR} on another DDS, {says}",
    }
    assert {network.resource_of(each) for each in network.troubles} == {"tank"}
    network.look([], [])
    assert not network.troubles
