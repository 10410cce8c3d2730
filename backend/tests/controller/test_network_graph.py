"""The ROS graph as a document."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from statistics import median

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.io.network import NetworkWatch, network_steps, network_view, uses
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.service import show_network
from sequence_planner.controller.views.details import NetworkView
from sequence_planner.ros.transport import NetworkEndpoint, ServiceEnd
from support.cell import COMMAND, STATE, STATE_TYPE, Arm, bench, cell
from support.examples import TIMED
from support.waiting import until_async

from .test_network_watch import OBEYS, REPORTS

FEEDBACK = replace(REPORTS, topic="/arm/go/_action/feedback", type_name="arm_msgs/action/Go_FeedbackMessage")
GOAL = ServiceEnd("/arm/go/_action/send_goal", "arm_msgs/action/Go_SendGoal", "server", False, "/devices")


def view(*endpoints: NetworkEndpoint, ends: Sequence[ServiceEnd] | None = ()) -> NetworkView:
    station = cell()[0]
    return network_view(endpoints, ends, uses(station.pipelines, station.registry))


def test_who_publishes_and_who_reads_stands_at_the_topic_and_at_the_node() -> None:
    recorder = replace(REPORTS, direction="subscriber", node="/recorder", vendor="RustDDS")
    strange = replace(REPORTS, topic="/else", type_name="std_msgs/msg/String", node=None, transient_local=True)
    found = view(REPORTS, recorder, strange, OBEYS)
    state = found.topics[STATE]
    assert [each.node for each in state.publishers] == ["/devices"]
    assert [(each.node, each.vendor) for each in state.subscribers] == [("/recorder", "RustDDS")]
    assert (state.types, state.station is None) == ([STATE_TYPE], False)
    assert found.topics["/else"].station is None
    assert found.topics["/else"].publishers[0].quality.durability == "transient_local"
    assert set(found.nodes) == {"/devices", "/recorder"}
    devices = found.nodes["/devices"]
    assert (devices.publishes, devices.subscribes, devices.own) == ([STATE], [COMMAND], False)


def test_the_stations_topics_are_there_before_anybody_else() -> None:
    use = view().topics[COMMAND].station
    assert use is not None
    assert (use.resource, use.direction, use.peers, use.mismatches) == ("arm", "out", 0, [])
    assert use.type_hash == cell()[0].registry.type_hash(use.type)


def test_a_quality_that_is_not_agreed_on_is_shown_with_both_sides() -> None:
    lossy = replace(REPORTS, reliable=False)
    use = view(lossy, REPORTS).topics[STATE].station
    assert use is not None
    assert use.peers == 1
    [wrong] = use.mismatches
    assert (wrong.kind, wrong.policy, wrong.ours, wrong.theirs) == ("quality", "reliability", "reliable", "best_effort")
    assert "the publisher offers best_effort, the subscriber wants reliable" in wrong.text
    wanting = replace(OBEYS, transient_local=True, deadline=0.5)
    use = view(wanting).topics[COMMAND].station
    assert use is not None
    told = [(each.policy, each.ours, each.theirs) for each in use.mismatches]
    assert told == [("durability", "volatile", "transient_local"), ("deadline", "none", "0.5 s")]


def test_types_definitions_and_rivals_are_shown_with_both_sides() -> None:
    ours = cell()[0].registry.type_hash(STATE_TYPE)
    mistyped, stale = replace(REPORTS, type_name="std_msgs/msg/String"), replace(REPORTS, type_hash="RIHS01_0")
    use = view(mistyped, stale).topics[STATE].station
    assert use is not None
    told = [(each.kind, each.ours, each.theirs) for each in use.mismatches]
    assert told == [("type", STATE_TYPE, "std_msgs/msg/String"), ("definition", ours, "RIHS01_0")]
    use = view(replace(OBEYS, direction="publisher", node="/other")).topics[COMMAND].station
    assert use is not None
    assert [(each.kind, each.node) for each in use.mismatches] == [("rival", "/other")]


def test_an_action_is_one_thing_and_not_its_topics_and_services() -> None:
    stop = ServiceEnd("/arm/stop", "std_srvs/srv/Trigger", "server", False, "/devices")
    asks = replace(stop, role="client", node=None)
    found = view(FEEDBACK, replace(FEEDBACK, direction="subscriber", node="/planner"), ends=[GOAL, stop, asks])
    assert set(found.topics) == {STATE, COMMAND}
    action = found.actions["/arm/go"]
    assert (action.types, action.servers, action.clients) == (["arm_msgs/action/Go"], ["/devices"], ["/planner"])
    assert (found.services["/arm/stop"].servers, found.services["/arm/stop"].clients) == (["/devices"], [None])
    assert (found.nodes["/devices"].services, found.nodes["/devices"].actions) == (["/arm/stop"], ["/arm/go"])
    assert found.services_known
    assert not view(ends=None).services_known


ENDPOINTS = st.builds(
    replace,
    st.sampled_from([REPORTS, OBEYS]),
    topic=st.sampled_from([STATE, COMMAND, "/else"]),
    type_name=st.sampled_from([STATE_TYPE, "std_msgs/msg/String"]),
    direction=st.sampled_from(["publisher", "subscriber"]),
    own=st.booleans(),
    node=st.sampled_from([None, "/a", "/b"]),
    reliable=st.booleans(),
    transient_local=st.booleans(),
    type_hash=st.sampled_from([None, "RIHS01_0"]),
)


@given(st.lists(ENDPOINTS, max_size=8))
def test_every_endpoint_stands_once_and_peers_are_those_that_the_alarms_know(endpoints: list[NetworkEndpoint]) -> None:
    found = view(*endpoints)
    assert sum(len(topic.publishers) + len(topic.subscribers) for topic in found.topics.values()) == len(endpoints)
    station = cell()[0]
    watch = NetworkWatch(station.pipelines, station.registry)
    watch.commands = True
    watch.look(endpoints)
    for name, topic in found.topics.items():
        if topic.station is not None:
            assert topic.station.peers == watch.peers[name]
            troubles = {each.text for each in topic.station.mismatches}
            assert troubles >= {
                text for kind in (watch.troubles, watch.rivals) for n, text in kind.items() if n == name
            }
            assert bool(troubles) == (name in watch.troubles or name in watch.rivals)


def test_the_graph_is_published_only_when_it_has_changed() -> None:
    class Link(ControllerLink):
        def __init__(self) -> None:
            self.told: list[NetworkView] = []

        def publish_network(self, network: NetworkView) -> None:
            self.told.append(network)

    async def scenario() -> None:
        async with bench() as b:
            link = Link()
            showing = asyncio.create_task(show_network(b.controller.devices.network, link))
            await until_async(lambda: bool(link.told) and STATE in link.told[-1].nodes["/sequence_planner"].subscribes)
            before = len(link.told)
            looks = b.controller.devices.network.seen
            await until_async(lambda: b.controller.devices.network.seen is not looks)
            arm = Arm(b.network)
            await until_async(lambda: len(link.told) > before and "/emulated_devices" in link.told[-1].nodes)
            assert len(link.told) <= before + 1
            assert link.told[-1].services_known
            arm.transport.close()
            await until_async(lambda: "/emulated_devices" not in link.told[-1].nodes)
            showing.cancel()

    asyncio.run(scenario())


def test_a_network_of_five_hundred_topics_is_described_in_little_time() -> None:
    endpoints = [
        replace(each, topic=f"/topic_{number}", node=f"/node_{number % 50}")
        for number in range(500)
        for each in (REPORTS, OBEYS)
    ]
    whole, longest = [], []
    for _ in range(5):
        steps = [time.process_time()]
        for _ in network_steps(endpoints, [], {}):
            steps.append(time.process_time())
        whole.append(steps[-1] - steps[0])
        longest.append(max(after - before for before, after in pairwise(steps)))
    assert len(view(*endpoints).topics) == 502
    assert not TIMED or median(whole) < 0.1
    assert not TIMED or median(longest) < 0.02, "no tick is held up by a step"
