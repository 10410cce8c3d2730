"""Types found on the network: finding out the type of a topic that somebody publishes, and answering others that ask.

Programs with Cyclone DDS tell their types by themselves (DDS-XTypes), and every node of ROS 2 since Iron answers on
`<node>/get_type_description`. What they say is believed only when its hash is the one that comes with the endpoint; who
tells no hash is no node of ROS 2 and is believed as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from sequence_planner.ros.transport import NetworkEndpoint, Transport, TransportError
from sequence_planner.ros.types.definitions import ON_THE_WIRE, as_uint8
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.type_description import (
    BadDescriptionError,
    FoundType,
    TypeDescription,
    check_hash,
    describe,
    read_description,
)

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs

_SERVICE = "type_description_interfaces/srv/GetTypeDescription"


@runtime_checkable
class TellsTypes(Protocol):
    """A transport whose middleware can tell types by itself."""

    async def describe(self, endpoint: NetworkEndpoint, within: float) -> TypeDescription | None:
        """Return what can be told of the type of a foreign endpoint, within so many seconds; None for nothing.

        Raises BadDescriptionError for a type that ROS 2 cannot have, and when nobody tells it.
        """


class TypeNotFoundError(TransportError):
    """The type of a topic cannot be found; the text says whom that was asked, and why it came to nothing."""


async def find_type(
    transport: Transport, registry: MessageRegistry, endpoint: NetworkEndpoint, within: float
) -> FoundType:
    """Find out the type of `endpoint`, within so many seconds for each way, and enter it into `registry`.

    DDS itself is asked first, where it can tell, then the node. The types within the type are entered as well, unless
    they are known. Raises TypeNotFoundError when nobody answers, or not the truth, and when the type differs from a
    known one of the same name. Nothing has been entered then. A type found before is returned without asking.
    """
    name = endpoint.type_name
    known = registry.found().get(name)
    if known is not None and known.type_hash == (endpoint.type_hash or known.type_hash):
        return known
    reasons = []
    for way, ask in (("DDS", _ask_middleware), (f"{endpoint.node}/get_type_description", _ask_node)):
        try:
            described = _as_known(registry, read_description(await ask(transport, registry, endpoint, within), name))
            if endpoint.type_hash is not None:
                check_hash(described, name, endpoint.type_hash)
        except (ValueError, TransportError) as error:
            reasons.append(f"{way} was asked for {name}: {error}")
        else:
            found = _enter(registry, described, endpoint)
            return found.get(name) or FoundType(name, registry.type_hash(name), _who(endpoint))
    reasons.append("write the definition into the station's messages folder")
    raise TypeNotFoundError(f"{endpoint.topic}: {'; '.join(reasons)}")


def serve_types(transport: Transport, registry: MessageRegistry, node_name: str) -> None:
    """Answer those who ask for the types that the node `node_name` uses; raises as `Transport.serve` does."""

    async def answer(request: bytes) -> bytes:
        wanted = registry.decode(f"{_SERVICE}_Request", request)
        name, wanted_hash = str(wanted["type_name"]), str(wanted["type_hash"])
        try:
            ours = registry.type_hash(name)
        except UnknownMessageTypeError as error:
            return registry.encode(f"{_SERVICE}_Response", {"failure_reason": str(error)})
        if wanted_hash not in ("", ours):
            return registry.encode(f"{_SERVICE}_Response", {"failure_reason": f"the hash of {name} is {ours}"})
        description = describe(registry.declared(), name).model_dump()
        return registry.encode(f"{_SERVICE}_Response", {"successful": True, "type_description": description})

    transport.serve(f"/{node_name}/get_type_description", _SERVICE, answer)


async def _ask_middleware(
    transport: Transport, registry: MessageRegistry, endpoint: NetworkEndpoint, within: float
) -> TypeDescription:
    description = await transport.describe(endpoint, within) if isinstance(transport, TellsTypes) else None
    if description is None:
        raise BadDescriptionError("it knows nothing of that type")
    return description


async def _ask_node(
    transport: Transport, registry: MessageRegistry, endpoint: NetworkEndpoint, within: float
) -> TypeDescription:
    if endpoint.node is None or endpoint.type_hash is None:
        raise BadDescriptionError("the program does not tell its node, or not the hash of the type")
    request = {"type_name": endpoint.type_name, "type_hash": endpoint.type_hash, "include_type_sources": False}
    data = registry.encode(f"{_SERVICE}_Request", request)
    service = f"{endpoint.node}/get_type_description"
    answer = registry.decode(f"{_SERVICE}_Response", await transport.call(service, _SERVICE, data, within))
    if not answer["successful"]:
        raise BadDescriptionError(f"it refused ({answer['failure_reason']})")
    return TypeDescription.model_validate(answer["type_description"])


def _as_known(registry: MessageRegistry, described: Mapping[str, Fielddefs]) -> dict[str, Fielddefs]:
    """Return the types with our own definition wherever it means the same bytes: DDS does not tell byte from uint8."""
    declared = registry.declared()

    def ours(name: str, fields: Fielddefs) -> Fielddefs:
        same = name in declared and as_uint8(declared[name], ON_THE_WIRE) == as_uint8(fields, ON_THE_WIRE)
        return declared[name] if same else fields

    return {name: ours(name, fields) for name, fields in described.items()}


def _enter(
    registry: MessageRegistry, described: dict[str, Fielddefs], endpoint: NetworkEndpoint
) -> dict[str, FoundType]:
    declared = registry.declared()
    for name, fields in described.items():
        if name in declared and declared[name] != fields:
            raise TypeNotFoundError(
                f"{endpoint.topic}: {_who(endpoint)} uses another definition of {name} than this station, "
                f"whose hash is {registry.type_hash(name)}; a name can have one definition only"
            )
    new = {name: fields for name, fields in described.items() if name not in declared}
    return registry.enter_found(new, _who(endpoint))


def _who(endpoint: NetworkEndpoint) -> str:
    return endpoint.node or "a program that does not tell its node"
