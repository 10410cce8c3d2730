"""Network access with Cyclone DDS: participant configuration, raw CDR samples, receiver thread."""

from __future__ import annotations

import gc
import sys
import threading
import time
from collections.abc import Iterator
from queue import Empty, SimpleQueue
from typing import ClassVar, Protocol, Self
from weakref import WeakValueDictionary
from xml.sax.saxutils import quoteattr

import structlog
from cyclonedds.core import (
    DDSException,
    Entity,
    GuardCondition,
    InstanceState,
    ReadCondition,
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.internal import SampleInfo
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.util import duration

from sequence_planner.ros import environment
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.environment import DiscoveryRange
from sequence_planner.ros.transport import Sample, TransportError
from sequence_planner.ros.types.definitions import PLACEHOLDER, FieldType
from sequence_planner.ros.types.messages import MessageRegistry

# Joining the DDS network with cyclonedds.
#
# Unless told otherwise a station stays on the loopback interface: cyclonedds is configured to use no other, to send no
# multicast, and to look for peers on the first ports of this computer. A configuration belongs to a domain and can be
# set once in a process, before its first participant.

#: Participants that can be found on one computer and domain.
MAX_PARTICIPANTS = 32

#: Participants that one process may have: in the next one cyclonedds never ends making a topic, and takes all memory.
MOST_IN_PROCESS = 31

_participants: WeakValueDictionary[int, DomainParticipant] = WeakValueDictionary()
_domains: WeakValueDictionary[int, Domain] = WeakValueDictionary()
_lock = threading.Lock()


def loopback_configuration() -> str:
    """Return the cyclonedds configuration that reaches this computer only."""
    interface = "lo0" if sys.platform == "darwin" else "lo"
    return f"""<CycloneDDS><Domain>
      <General>
        <Interfaces><NetworkInterface name="{interface}"/></Interfaces>
        <AllowMulticast>false</AllowMulticast>
      </General>
      <Discovery>
        <ParticipantIndex>auto</ParticipantIndex>
        <MaxAutoParticipantIndex>{MAX_PARTICIPANTS}</MaxAutoParticipantIndex>
        <Peers><Peer address="localhost"/></Peers>
      </Discovery>
    </Domain></CycloneDDS>"""


def interface_configuration(interface: str) -> str:
    """Return the cyclonedds configuration that uses the network interface of this name and no other."""
    return f"""<CycloneDDS><Domain>
      <General><Interfaces><NetworkInterface name={quoteattr(interface)}/></Interfaces></General>
    </Domain></CycloneDDS>"""


def join(domain_id: int, discovery: DiscoveryRange) -> tuple[Domain | None, DomainParticipant]:
    """Return a participant of the domain, and the domain's configuration, which must live as long.

    With the range LOCALHOST the loopback configuration holds. With SUBNET it is the interface that the environment
    names, if any; without one, and with SYSTEM_DEFAULT, the configuration of CYCLONEDDS_URI, if any. Raises
    TransportError when there is no network to join, or one that this library must not join.
    """
    if environment.security_wanted():
        raise TransportError(
            f"{environment.SECURITY} asks for DDS Security, which this build of cyclonedds lacks: use ROS 2 with rclpy"
        )
    if discovery is DiscoveryRange.OFF:
        raise TransportError(f"{environment.DISCOVERY_RANGE} is OFF, so no device could be found: use LOCALHOST")
    interface = environment.interface(discovery)
    _require_room()
    qos = Qos(Policy.Userdata(b"enclave=/;"))
    try:
        domain = None
        if discovery is DiscoveryRange.LOCALHOST:
            domain = _configured(domain_id, loopback_configuration())
        elif interface is not None:
            domain = _configured(domain_id, interface_configuration(interface))
        participant = DomainParticipant(domain_id, qos)
    except DDSException as error:
        way = "loopback interface" if discovery is DiscoveryRange.LOCALHOST else "network interface"
        raise TransportError(
            f"DDS cannot join domain {domain_id} ({error}). Check that a {way} is up, that fewer than "
            f"{MAX_PARTICIPANTS} programs share the domain on this computer, and what CYCLONEDDS_URI says"
        ) from error
    _participants[id(participant)] = participant
    return domain, participant


def leave(participant: DomainParticipant) -> None:
    """Take a participant off the network."""
    _participants.pop(id(participant), None)
    release(participant)


def _require_room() -> None:
    """Raises `TransportError` where this process has as many participants as it may have."""
    if len(_participants) >= MOST_IN_PROCESS:
        gc.collect()  # one that nobody has any more may still be there
    if len(_participants) >= MOST_IN_PROCESS:
        raise TransportError(
            f"one process can be on a DDS network {MOST_IN_PROCESS} times, and an emulated device is there by itself: "
            "emulate the devices of some resources in another one, with `sequence-planner emulate --resource`"
        )


def _configured(domain_id: int, configuration: str) -> Domain:
    with _lock:
        domain = _domains.get(domain_id)
        if domain is None:
            domain = _domains[domain_id] = Domain(domain_id, configuration)
        return domain


def release(entity: Entity) -> None:
    """Delete a DDS entity now.

    cyclonedds deletes an entity when Python frees the object, and has no other way; a reference cycle inside the
    library would put that off, and the peers would go on seeing us.
    """
    entity.__del__()


# Raw CDR through cyclonedds.
#
# cyclonedds for Python turns samples into bytes with classes generated from IDL, which is slow for large messages and
# would be a second codec beside ours. But it only ever asks a class for `__idl__`, `serialize` and `deserialize`, so a
# class that has them and holds the bytes themselves sends and receives raw CDR. Its `__idl__` describes the true fields
# all the same: cyclonedds peers compare it, and do not match when the definitions differ.

_PRIMITIVES: dict[str, object] = {
    "bool": bool,
    "byte": types.uint8,
    "string": str,
    "float32": types.float32,
    "float64": types.float64,
    "int8": types.int8,
    "int16": types.int16,
    "int32": types.int32,
    "int64": types.int64,
    "uint8": types.uint8,
    "uint16": types.uint16,
    "uint32": types.uint32,
    "uint64": types.uint64,
}


class RawSample:
    """CDR bytes, header included, in the form cyclonedds hands about. Each message type has its subclass."""

    __idl__: ClassVar[object]
    __slots__ = ("data", "sample_info")
    sample_info: SampleInfo

    def __init__(self, data: bytes) -> None:
        self.data = data

    def serialize(self, use_version_2: bool | None = None) -> bytes:
        """Return the bytes as they are."""
        return self.data

    @classmethod
    def deserialize(cls, data: bytes) -> Self:
        """Return a sample of the bytes as they are."""
        return cls(data)

    @classmethod
    def deserialize_key(cls, data: bytes) -> Self:
        """Return a sample of the bytes of a key; ROS 2 has no keys, so there is nothing in it."""
        return cls(data)


#: What Cyclone's mapping of services puts before a request or a response: whose call it is, and the number of the call.
#: ROS 2 has no field with two underscores, so these names are free.
_CALL_HEADER: dict[str, object] = {"call__client": types.uint64, "call__number": types.int64}


class RawTypes(Protocol):
    """Gives a message type its class, made on first use; raises UnknownMessageTypeError.

    With `called`, it is that of a request or response, before which the header of a call stands.
    """

    def __call__(self, type_name: str, *, called: bool = False) -> type[RawSample]:
        """Return the class."""


def raw_types(registry: MessageRegistry) -> RawTypes:
    """Return the function that gives the types of `registry` their classes."""
    structs: dict[str, type[IdlStruct]] = {}
    classes: dict[tuple[str, bool], type[RawSample]] = {}

    def struct(type_name: str) -> type[IdlStruct]:
        if type_name not in structs:
            structs[type_name] = made(type_name, {})
        return structs[type_name]

    def made(type_name: str, header: dict[str, object]) -> type[IdlStruct]:
        fields = {name: annotation(field) for name, field in registry.fields(type_name).items()}
        dotted = registry.dds_name(type_name).replace("::", ".")
        # As a dataclass it could not have a field named like a Python keyword, and nobody makes an instance of it.
        name = type_name.replace("/", "__")
        return make_idl_struct(name, dotted, header | (fields or {PLACEHOLDER: types.uint8}), dataclassify=False)

    def annotation(field: FieldType) -> object:
        element: object
        if field.kind == "message":
            element = struct(field.type_name)
        elif field.max_length:
            element = types.bounded_str[field.max_length]
        else:
            element = _PRIMITIVES[field.type_name]
        if field.array is None:
            return element
        if field.array == "sequence":
            return types.sequence[element, field.max_items] if field.max_items else types.sequence[element]
        return types.array[element, field.array]

    def raw(type_name: str, *, called: bool = False) -> type[RawSample]:
        key = (type_name, called)
        if key not in classes:
            idl = (made(type_name, _CALL_HEADER) if called else struct(type_name)).__idl__
            classes[key] = type(type_name.replace("/", "__"), (RawSample,), {"__idl__": idl, "__slots__": ()})
        return classes[key]

    return raw


# The thread that takes samples from cyclonedds.
#
# DDS listeners run on the library's own threads, swallow exceptions and can fire before their reader is known. A wait
# set has none of that: one thread sleeps until any reader has samples, takes them all and queues them for the event
# loop. A guard condition wakes the thread when a reader joins or the transport closes.

_log = structlog.get_logger(__name__)

#: Samples taken in one call.
_CHUNK = 256

_UNREAD = ViewState.Any | InstanceState.Any | SampleState.NotRead


def take_all(reader: DataReader[RawSample]) -> Iterator[RawSample]:
    """Yield what waits in `reader`, without the notices that a publisher came or went, which carry no data."""
    while True:
        taken = reader.take(_CHUNK)
        yield from (sample for sample in taken if isinstance(sample, RawSample) and sample.sample_info.valid_data)
        if len(taken) < _CHUNK:
            return


class Receiver:
    """One thread that serves all subscriptions of a participant. Call its methods on the event loop's thread."""

    def __init__(self, participant: DomainParticipant, name: str) -> None:
        self._waitset = WaitSet(participant)
        self._wake = GuardCondition(participant)
        self._waitset.attach(self._wake)
        self._joining: SimpleQueue[tuple[str, DataReader[RawSample], Delivery]] = SimpleQueue()
        self._serving: list[tuple[str, DataReader[RawSample], Delivery, ReadCondition]] = []
        self._closing = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, topic: str, reader: DataReader[RawSample], delivery: Delivery) -> None:
        """Take the samples of `reader` from now on, and those that wait in it."""
        self._joining.put((topic, reader, delivery))
        self._wake.set(True)

    def close(self) -> None:
        """End the thread. What it has queued for the event loop is the deliveries' affair."""
        self._closing = True
        self._wake.set(True)
        self._thread.join()
        release(self._waitset)
        for _, _, _, condition in self._serving:
            release(condition)
        release(self._wake)

    def _run(self) -> None:
        while not self._closing:
            try:
                self._waitset.wait(duration(infinite=True))
                self._wake.take()
                self._admit()
                for topic, reader, delivery, _ in self._serving:
                    samples = list(take_all(reader))
                    received = time.monotonic()
                    delivery.push(
                        Sample(topic, sample.data, received, sample.sample_info.publication_handle)
                        for sample in samples
                    )
            except DDSException:
                _log.exception("DDS failed while receiving")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.

    def _admit(self) -> None:
        while True:
            try:
                topic, reader, delivery = self._joining.get_nowait()
            except Empty:
                return
            condition = ReadCondition(reader, _UNREAD)
            self._serving.append((topic, reader, delivery, condition))
            self._waitset.attach(condition)
