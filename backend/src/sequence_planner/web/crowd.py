"""Who has connections open, and whose is closed when there are too many.

Nobody is known before the head of a request has come. Those who are not known have places of their own, so however many
they are, whoever is signed in finds one. A connection too many closes the oldest of those who have most, so that a
newcomer need not wait until somebody who asks for nothing has been given up.
"""

from __future__ import annotations

from asyncio import Transport
from collections import Counter
from enum import Enum
from ipaddress import IPv6Address, IPv6Network

from starlette.types import Scope

from sequence_planner.web.settings import address_of

# Connections that are accepted in one go: fewer than one address may have, so that none of them is closed by the others
# before what it asks for was looked at.
ACCEPTED_AT_ONCE = 128
IN_SCOPE = "sequence_planner.place"


class Kind(Enum):
    """Whom connections belong to."""

    ADDRESS = "address"  # somebody who has not shown who they are
    PROXY = "proxy"  # whoever a proxy will say
    BEARER = "bearer"  # a session, a watch or a key


MOST_UNKNOWN, MOST_KNOWN = 600, 300  # connections at once, streams included
MOST_OF_ONE = {Kind.ADDRESS: 200, Kind.PROXY: MOST_UNKNOWN, Kind.BEARER: 60}

Group = tuple[Kind, str]


class Crowd:
    """All connections of a server, by whom they belong to; the one that asked last stands last."""

    def __init__(self) -> None:
        self._groups: dict[Transport, Group] = {}
        self._sizes: Counter[Group] = Counter()

    def put(self, transport: Transport, group: Group) -> None:
        """Let a connection belong to a group from now on, at the cost of an older one where there are too many."""
        self.leave(transport)
        self._groups[transport] = group
        self._sizes[group] += 1
        if self._sizes[group] > MOST_OF_ONE[group[0]]:
            self._close_oldest(group)
            return
        is_known = group[0] is Kind.BEARER
        sizes = {each: size for each, size in self._sizes.items() if (each[0] is Kind.BEARER) == is_known}
        if sum(sizes.values()) > (MOST_KNOWN if is_known else MOST_UNKNOWN):
            self._close_oldest(max(sizes, key=sizes.__getitem__))

    def leave(self, transport: Transport) -> None:
        """Count a connection no more."""
        group = self._groups.pop(transport, None)
        if group is not None:
            self._sizes[group] -= 1
            if not self._sizes[group]:
                del self._sizes[group]

    def _close_oldest(self, group: Group) -> None:
        oldest = next(transport for transport, each in self._groups.items() if each == group)
        self.leave(oldest)
        oldest.abort()  # whoever takes no answer would not take the rest of it either


class Place:
    """One connection's place among all."""

    def __init__(self, crowd: Crowd, transport: Transport, group: Group) -> None:
        self._crowd = crowd
        self._transport = transport
        self._group = group
        crowd.put(transport, group)

    def asks(self) -> None:
        """Count it as the newest."""
        self._crowd.put(self._transport, self._group)

    def belongs_to(self, group: Group) -> None:
        """Say whose it is."""
        self._group = group
        if not self._transport.is_closing():
            self._crowd.put(self._transport, group)


def group_of_address(address: str) -> Group:
    """An address; of IPv6 the 64-bit network that one host has for itself (RFC 4291, 2.5.4)."""
    found = address_of(address.partition("%")[0])
    if isinstance(found, IPv6Address) and not found.is_loopback:
        return Kind.ADDRESS, str(IPv6Network((found, 64), strict=False))
    return Kind.ADDRESS, str(found or address)


def belongs_to(scope: Scope, group: Group) -> None:
    """Say whose the connection of a request is, where there is one."""
    place: Place | None = scope.get(IN_SCOPE)
    if place is not None:
        place.belongs_to(group)
