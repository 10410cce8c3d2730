"""What our endpoints announce is what a genuine node of ROS 2 Jazzy announces, and what it announces is understood."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import suppress

import pytest
from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from hypothesis import given
from hypothesis import strategies as st
from jazzy_facts import Announced, announced
from ros_networks import Network, play, standard

from sequence_planner.ros import names
from sequence_planner.ros.actions import ActionClient, ActionServer, GoalOutcome, GoalStatus, GoalWork
from sequence_planner.ros.call_header import CallHeader, split_header, with_header
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.cyclonedds_network import RawSample, raw_types, take_all
from support.examples import examples
from support.network import DOMAIN
from support.waiting import until_async

SET, FIBONACCI = "std_srvs/srv/SetBool", "example_interfaces/action/Fibonacci"
IDENTITIES = ("serviceid", "clientid")
RAW = raw_types(standard())


async def unasked(request: bytes) -> bytes:
    """Nobody calls it."""
    return request


async def idle(work: GoalWork) -> GoalOutcome:
    """Nobody asks for it."""
    return GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": []})


def seen_by(participant: DomainParticipant) -> Iterator[tuple[tuple[str, str, str], dict[str, str]]]:
    """Yield direction, topic and type of each endpoint on the network, and what its user data say."""
    for direction, topic in (
        ("publisher", BuiltinTopicDcpsPublication),
        ("subscriber", BuiltinTopicDcpsSubscription),
    ):
        for each in BuiltinDataReader(participant, topic).take(1000):
            if each.participant_key != participant.guid and Policy.Userdata in each.qos:
                data = each.qos[Policy.Userdata].data.decode()
                yield (
                    (direction, each.topic_name, each.type_name),
                    Announced(
                        direction=direction, topic="", type="", user_data=data, depth=None, transient_local=False
                    ).tells,
                )


def test_the_hashes_of_genuine_endpoints_are_ours() -> None:
    for each in announced():
        told = names.type_hash_of(each.user_data.encode())
        assert told == standard().type_hash(names.ros_type(each.type)), each


def test_the_identities_of_genuine_endpoints_are_read_and_written_alike() -> None:
    told = [(key, each) for each in announced() for key in IDENTITIES if key in each.tells]
    assert len(told) > 10
    for key, each in told:
        data = each.user_data.encode()
        server, client = names.server_of(data), names.client_of(data)
        assert (server, client) == ((each.tells[key], None) if key == "serviceid" else (None, each.tells[key]))
        write = names.server_user_data if key == "serviceid" else names.client_user_data
        identity = bytes(int(byte, 16) for byte in each.tells[key].split("."))
        assert data.startswith(write(identity))


@given(st.binary(min_size=16, max_size=16))
@examples(50)
def test_an_identity_comes_back(identity: bytes) -> None:
    for write, read, other in (
        (names.server_user_data, names.server_of, names.client_of),
        (names.client_user_data, names.client_of, names.server_of),
    ):
        told = read(write(identity) + names.type_hash_user_data(standard().type_hash(SET)))
        assert told is not None
        assert bytes(int(byte, 16) for byte in told.split(".")) == identity
        assert told[2] == "."  # the first byte takes two places, as in C++'s `setw(2)`
        assert other(write(identity)) is None


def test_our_endpoints_tell_what_genuine_ones_tell() -> None:
    """The same node, made with our transport, tells the same topics, types and hashes, and identities alike."""

    async def scenario(network: Network) -> None:
        station = network.join("genuine")
        station.serve("/cell/set", SET, unasked)
        server = ActionServer(station, standard(), "/cell/fib", FIBONACCI, idle)
        client = ActionClient(station, standard(), "/cell/other", FIBONACCI)
        with suppress(TransportError):
            await station.call("/cell/ask", SET, standard().encode(f"{SET}_Request", {}), 0.01)
        for service in ("send_goal", "get_result", "cancel_goal"):
            kind = f"{FIBONACCI}_{service.title().replace('_', '')}"
            kind = "action_msgs/srv/CancelGoal" if service == "cancel_goal" else kind
            with suppress(TransportError):
                request = standard().encode(f"{kind}_Request", {})
                await station.call(f"/cell/other/_action/{service}", kind, request, 0.01)
        participant = DomainParticipant(DOMAIN)
        expected = {
            (each.direction, each.topic, each.type): each.tells
            for each in announced()
            if each.topic == "ros_discovery_info" or each.topic.split("/")[2].startswith(("set", "ask", "fib", "other"))
        }
        await until_async(lambda: expected.keys() <= dict(seen_by(participant)).keys(), "all endpoints are seen")
        ours = dict(seen_by(participant))
        assert {key: told["typehash"] for key, told in ours.items() if key in expected} == {
            key: told["typehash"] for key, told in expected.items()
        }
        identities: dict[str, set[str]] = {}
        for key, theirs in expected.items():
            assert ours[key].keys() == theirs.keys()
            for identity in IDENTITIES:
                if identity in theirs:
                    identities.setdefault(ours[key][identity], set()).add(key[1])
        # Both endpoints of a client or a server bear one identity, which nobody else has.
        assert sorted(len(topics) for topics in identities.values()) == [2] * 8
        assert client.malformed == 0
        server.close()

    play("cyclonedds", scenario)


def quality(data: bytes) -> Qos:
    policies = (Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
    return Qos(*policies, Policy.Userdata(data))


def told_by(topic: str, identity: str) -> bytes:
    """User data of a genuine endpoint, for another identity than it has."""
    [found] = [each for each in announced() if each.topic == topic]
    key = next(iter(found.tells))
    return f"{key}={identity};typehash={found.tells['typehash']};".encode()


def took(reader: DataReader[RawSample], taken: list[RawSample]) -> bool:
    """Whether a sample has come by now, which is then in `taken`."""
    taken += take_all(reader)
    return bool(taken)


@pytest.mark.parametrize("first_byte", [" 1", " 0", "ff"])
def test_a_server_that_announces_itself_as_rmw_cyclonedds_does_is_called(first_byte: str) -> None:
    async def scenario(network: Network) -> None:
        station, participant = network.join("station"), DomainParticipant(DOMAIN)
        identity = f"{first_byte}.10.69.93.dd.c3.a.6d.6e.1c.5b.31.0.0.0.8"
        request, reply = (RAW(f"{SET}_{part}", called=True) for part in ("Request", "Response"))
        asked: Topic[RawSample] = Topic(participant, "rq/cell/setRequest", request)
        answered: Topic[RawSample] = Topic(participant, "rr/cell/setReply", reply)
        reader = DataReader(participant, asked, quality(told_by("rq/cell/setRequest", identity)))
        writer = DataWriter(participant, answered, quality(told_by("rr/cell/setReply", identity)))
        calling = asyncio.ensure_future(
            station.call("/cell/set", SET, standard().encode(f"{SET}_Request", {"data": True}), 20.0)
        )
        taken: list[RawSample] = []
        await until_async(lambda: took(reader, taken) or calling.done(), "the server is asked")
        found = split_header(taken[0].data)
        assert found is not None
        assert standard().decode(f"{SET}_Request", found[1]) == {"data": True}
        body = standard().encode(f"{SET}_Response", {"success": True, "message": "done"})
        writer.write(reply(with_header(found[0], body)))
        assert standard().decode(f"{SET}_Response", await calling) == {"success": True, "message": "done"}

    play("cyclonedds", scenario)


def test_a_client_that_announces_itself_as_rmw_cyclonedds_does_is_answered() -> None:
    async def scenario(network: Network) -> None:
        station, participant = network.join("station"), DomainParticipant(DOMAIN)

        async def ask(request: bytes) -> bytes:
            return standard().encode(
                f"{SET}_Response", {"success": standard().decode(f"{SET}_Request", request)["data"]}
            )

        station.serve("/cell/ask", SET, ask)
        identity = " 1.10.69.93.dd.c3.a.6d.6e.1c.5b.31.0.0.0.9"
        request, reply = (RAW(f"{SET}_{part}", called=True) for part in ("Request", "Response"))
        asked: Topic[RawSample] = Topic(participant, "rq/cell/askRequest", request)
        answered: Topic[RawSample] = Topic(participant, "rr/cell/askReply", reply)
        writer = DataWriter(participant, asked, quality(told_by("rq/cell/askRequest", identity)))
        reader = DataReader(participant, answered, quality(told_by("rr/cell/askReply", identity)))
        await until_async(writer.get_matched_subscriptions, "the server is seen")
        body = standard().encode(f"{SET}_Request", {"data": True})
        writer.write(request(with_header(CallHeader(7, 1), body)))
        taken: list[RawSample] = []
        await until_async(lambda: took(reader, taken), "the client is answered")
        found = split_header(taken[0].data)
        assert found is not None
        assert found[0] == CallHeader(7, 1)
        assert standard().decode(f"{SET}_Response", found[1])["success"] is True

    play("cyclonedds", scenario)
