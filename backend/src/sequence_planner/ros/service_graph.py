"""Who serves and who calls services, where a transport can tell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

Role = Literal["server", "client"]


@dataclass(frozen=True)
class ServiceEnd:
    """A server or a client of a service, `type_name` as in `package/srv/Name`; `own` is this transport's.

    `node` and `vendor` (of its middleware) are None where it does not tell. It is `understood` where it puts the number
    of a call in the same place as this transport does.
    """

    service: str
    type_name: str
    role: Role
    own: bool
    node: str | None
    vendor: str | None = None
    understood: bool = True


@runtime_checkable
class TellsServices(Protocol):
    """A transport that knows the ends of services, those of actions among them."""

    def services(self) -> list[ServiceEnd]:
        """Return the servers and clients that were known when the graph was last asked for."""
