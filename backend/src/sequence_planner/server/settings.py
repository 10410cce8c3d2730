"""The settings of the server: where it listens, by which names it is opened, and what it serves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from ipaddress import IPv4Address, IPv6Address, ip_address
from pathlib import Path

from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.backup.settings import Keeping
from sequence_planner.db.location import revisions_folder
from sequence_planner.mes.webhooks.targets import Targets
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.retention.settings import Retention

LOCALHOST = "localhost"
LOOPBACK_NAMES = ("127.0.0.1", LOCALHOST, "[::1]")
NAME = re.compile(
    r"(?P<host>[a-z0-9]([a-z0-9._-]{0,251}[a-z0-9])?|\[[0-9a-f:.]+\])(:(?P<port>[1-9][0-9]{0,4}))?", re.IGNORECASE
)
LARGEST_RECORDING = 500  # MB
STANDARD_PORTS = {"http": 80, "https": 443}


class SettingsError(Exception):
    """The server cannot start as asked; the message says what to do. The exit code is 2."""


@dataclass(frozen=True)
class StreamLimits:
    """The limits of what one client of the stream may ask of the server."""

    queue: int = 32  # messages; a client that is further behind gets one fresh snapshot instead
    send_seconds: float = 5.0  # a client that takes no message for so long is dropped
    frame: int = 4096  # bytes in a frame from a client
    clients: int = 100
    of_one: int = 25  # of these for one person, key or watch, so that nobody takes the place of all others


@dataclass(frozen=True, kw_only=True)
class Endpoint:
    """The place where the server is reached, and how; `check_endpoint` says whether it may be.

    `host` is an address of this machine or `localhost`. With `certificate` and `private_key` (PEM) it speaks HTTPS
    itself; with `proxies`, the addresses of reverse proxies that do, it serves those and nobody else. `names` are the
    host names, with a port where it is not the usual one, by which people open it. `wall_beside` are the addresses of
    other stations: each shows this one's wall beside its own, and this one theirs.
    """

    host: str = "127.0.0.1"
    port: int = 8000
    certificate: Path | None = None
    private_key: Path | None = None
    proxies: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    wall_beside: tuple[str, ...] = ()

    @property
    def https(self) -> bool:
        """True if browsers speak HTTPS to it."""
        return self.certificate is not None or bool(self.proxies)

    @property
    def scheme(self) -> str:
        """`https` or `http`, as browsers speak to it."""
        return "https" if self.https else "http"

    @property
    def loopback(self) -> bool:
        """True if only this machine reaches it."""
        found = address_of(self.host)
        return found is not None and found.is_loopback

    @property
    def hosts(self) -> frozenset[str]:
        """The values of the Host header that mean this server, in small letters."""
        return frozenset(self._hosts())

    @property
    def origins(self) -> frozenset[str]:
        """The values of the Origin header that are pages of this server, in small letters."""
        return frozenset(f"{self.scheme}://{host}" for host in self.hosts)

    @property
    def address(self) -> str:
        """The address that people open: by the first of its names, or else where it listens."""
        return f"{self.scheme}://{next(self._hosts())}"

    @property
    def beside(self) -> tuple[str, ...]:
        """The origins of the stations whose walls stand beside this one's, as browsers write them, each once."""
        return tuple(dict.fromkeys(origin_of(each) for each in self.wall_beside))

    def _hosts(self) -> Iterator[str]:
        """Each name as browsers send it, the first of its spellings first."""
        standard = STANDARD_PORTS[self.scheme]
        for name in self._names():
            host, port = split_name(name)
            port = port or (standard if self.proxies else self.port)
            if port == standard:
                yield host
            yield f"{host}:{port}"

    def _names(self) -> Iterator[str]:
        yield from self.names
        if self.loopback and not self.proxies:
            yield _as_name(self.host)
            yield from LOOPBACK_NAMES


@dataclass(frozen=True, kw_only=True)
class Settings(Endpoint):
    """All that the server needs to know; `page` is the folder of the built page, `model` that of the running station.

    With `transport` the network is joined for what a person wants to attach, as the controller joins it. `database`
    is the URL of where identity and journal are kept; `start` is how the station is run. With `demonstration` one may
    be opened without signing in, with `provider` people may sign in there. `webhooks` is where events may be sent to,
    `backups` how they are kept, and `retention` how long all else is. `examples` is a folder of example stations in
    place of those that come with the program. A recording that an engineer brings has at most `largest_recording`
    MB, as it comes and unpacked.
    """

    controller_socket: Path
    page: Path
    database: str
    model: Path | None = None
    transport: str = "auto"
    demonstration: bool = False
    start: StartNeeds = field(default_factory=StartNeeds)
    provider: ProviderSettings | None = None
    stream: StreamLimits = field(default_factory=StreamLimits)
    webhooks: Targets = field(default_factory=Targets)
    backups: Keeping = field(default_factory=Keeping)
    retention: Retention = field(default_factory=Retention)
    examples: Path | None = None
    largest_recording: int = LARGEST_RECORDING

    @property
    def revisions(self) -> Path | None:
        """The folder of the model's revisions; None where there is no model."""
        return None if self.model is None else revisions_folder(self.database, self.model)


def address_of(host: str) -> IPv4Address | IPv6Address | None:
    """The address that `host` writes, None if it is none. An IPv4 address written as one of IPv6 is that of IPv4."""
    try:
        found = ip_address("127.0.0.1" if host.lower() == LOCALHOST else host)
    except ValueError:
        return None
    return getattr(found, "ipv4_mapped", None) or found


def origin_of(url: str) -> str:
    """The origin of the server at `url`, as browsers write it: `https://HOST[:PORT]` or `http://HOST[:PORT]`.

    Raises `SettingsError` when it names more than a server, or none.
    """
    scheme, _, rest = url.partition("://")
    if scheme.lower() not in STANDARD_PORTS:
        raise SettingsError(f"{url!r} is not the address of a station; use --wall-beside with https:// and its name")
    try:
        host, port = split_name(rest.removesuffix("/"))
    except SettingsError:
        raise SettingsError(
            f"{url!r} is not the address of a station; use --wall-beside as in https://station-2.example:8443"
        ) from None
    scheme = scheme.lower()
    return f"{scheme}://{host}" if port in (None, STANDARD_PORTS[scheme]) else f"{scheme}://{host}:{port}"


def split_name(name: str) -> tuple[str, int | None]:
    """The host name of `HOST[:PORT]` in small letters, IPv6 addresses in brackets, and its port.

    Raises `SettingsError` when it is none.
    """
    written = NAME.fullmatch(name)
    if written is None or (port := int(written["port"] or 1)) > 65535:
        raise SettingsError(f"{name!r} is no name; use --name with what people open, such as station.example:8443")
    return _as_name(written["host"].strip("[]")), port if written["port"] else None


def _as_name(host: str) -> str:
    found = address_of(host)
    return f"[{found}]" if isinstance(found, IPv6Address) else host.lower()
