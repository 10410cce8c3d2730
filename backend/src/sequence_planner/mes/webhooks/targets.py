"""The places where webhooks may go: hosts and networks on a list, by HTTPS; off the public network only where the list
has the network.

A name is resolved for each delivery, and the addresses that were found are judged and then connected to, so that what a
name means cannot change in between (DNS rebinding).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address, ip_network
from typing import Final, TypeAlias
from urllib.parse import urlsplit

from sequence_planner.texts.message import Message, message

LONGEST_URL: Final = 2000  # characters
Address: TypeAlias = IPv4Address | IPv6Address
Network: TypeAlias = IPv4Network | IPv6Network
_NAT64: Final = IPv6Network("64:ff9b::/96")
_THIS_HOST: Final = IPv4Network("0.0.0.0/8")
_STANDARD_PORTS: Final = {"https": 443, "http": 80}
_VISIBLE: Final = frozenset(map(chr, range(0x21, 0x7F))) - frozenset('\\"<>^`{|}')


class TargetRefused(Exception):
    """Nothing is sent there; `why` says the reason."""

    def __init__(self, why: Message) -> None:
        super().__init__(why)
        self.why = why


@dataclass(frozen=True)
class Target:
    """A place that is on the list. `host` is in small letters, without brackets."""

    scheme: str
    host: str
    port: int
    path: str  # with the query

    @property
    def authority(self) -> str:
        """Host and port, as the header Host has them."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return host if self.port == _STANDARD_PORTS[self.scheme] else f"{host}:{self.port}"

    def at(self, address: str) -> str:
        """Its URL with an address in place of the name."""
        return f"{self.scheme}://{f'[{address}]' if ':' in address else address}:{self.port}{self.path}"


@dataclass(frozen=True)
class Targets:
    """The `hosts` that webhooks may go to, each with its port, in small letters and without brackets, and the
    `networks`, in which they may go to every host, and the hosts of the list may be although they are private.

    What is this machine, link-local (where clouds answer questions about themselves), multicast or reserved is sent to
    only where the list has exactly that address. With `loopback` what is on the list may be this machine too, also by
    HTTP.
    """

    hosts: frozenset[tuple[str, int]] = frozenset()
    loopback: bool = False
    networks: tuple[Network, ...] = ()

    @property
    def written(self) -> list[str]:
        """The hosts as `host_and_port` reads them."""
        return sorted(f"[{host}]:{port}" if ":" in host else f"{host}:{port}" for host, port in self.hosts)

    def target(self, url: str) -> Target:
        """Return what a URL names. Raises `TargetRefused` unless it may be sent to if its address may."""
        target = _read(url)
        if (target.host, target.port) not in self.hosts and not self.networks:
            raise TargetRefused(_not_listed(target))
        if target.scheme != "https" and not self.loopback:
            raise TargetRefused(message("target.https"))
        return target

    def judge(self, target: Target, addresses: Sequence[str]) -> None:
        """Raises `TargetRefused` when a target has no address, or one that may not be sent to."""
        listed = (target.host, target.port) in self.hosts
        for each in addresses:
            address = ip_address(each)
            meant, here = _meant(address), _is_loopback(address)
            exactly = (listed and _is_literal(target.host, address)) or _within(meant, self.networks, exactly=True)
            if here and not (self.loopback or exactly):
                raise TargetRefused(message("target.this-machine", host=target.host, address=each))
            if not listed and not _within(meant, self.networks):
                raise TargetRefused(
                    message("target.network-not-listed", host=target.host, port=target.port, address=each)
                )
            if here or exactly:
                pass
            elif _is_special(meant):
                raise TargetRefused(message("target.special", host=target.host, address=each))
            elif not _is_public(meant) and not _within(meant, self.networks):
                raise TargetRefused(message("target.not-public", host=target.host, address=each))
            if target.scheme != "https" and not here:
                raise TargetRefused(message("target.not-this-machine", host=target.host, address=each))
        if not addresses:
            raise TargetRefused(message("target.no-address", host=target.host))


def network(written: str) -> Network:
    """Return what a network on the list means, as in `10.1.2.0/24`. Raises `TargetRefused`."""
    try:
        found = ip_network(written)
    except ValueError:
        raise TargetRefused(message("target.no-network", written=repr(written))) from None
    if not found.prefixlen:
        raise TargetRefused(message("target.every-network", written=written))
    return found


def host_and_port(written: str) -> tuple[str, int]:
    """Return what `HOST[:PORT]` on the list means; without a port that of HTTPS. Raises `TargetRefused`."""
    target = _read(f"https://{written}/")
    if target.path != "/":
        raise TargetRefused(message("target.no-host", written=repr(written)))
    return target.host, target.port


def _read(url: str) -> Target:
    """Raises `TargetRefused` for what is not plainly a URL: how it is read must not depend on who reads it."""
    try:
        if len(url) > LONGEST_URL or not _VISIBLE.issuperset(url):
            raise ValueError
        split = urlsplit(url)
        host, port = (split.hostname or "").rstrip("."), split.port
        if split.scheme not in _STANDARD_PORTS or not host or "%" in host or split.netloc.endswith(":") or port == 0:
            raise ValueError
    except ValueError:
        raise TargetRefused(message("target.no-url", most=LONGEST_URL)) from None
    if "@" in split.netloc:
        raise TargetRefused(message("target.password"))
    if "#" in url:
        raise TargetRefused(message("target.fragment"))
    query = f"?{split.query}" if split.query else ""
    return Target(split.scheme, host, port or _STANDARD_PORTS[split.scheme], (split.path or "/") + query)


def _not_listed(target: Target) -> Message:
    return message("target.not-listed", host=target.host, port=target.port)


def _meant(address: Address) -> Address:
    """The address of IPv4 that one of IPv6 stands for, if it does."""
    if isinstance(address, IPv4Address):
        return address
    if address in _NAT64:
        return IPv4Address(int(address) & 0xFFFFFFFF)
    return address.ipv4_mapped or address.sixtofour or (address.teredo[1] if address.teredo else address)


def _is_literal(host: str, address: Address) -> bool:
    """Return whether the host is written as this address."""
    try:
        return ip_address(host) == address
    except ValueError:
        return False


def _within(address: Address, networks: Sequence[Network], *, exactly: bool = False) -> bool:
    return any(address in each for each in networks if not exactly or each.num_addresses == 1)


def _is_loopback(address: Address) -> bool:
    mapped = getattr(address, "ipv4_mapped", None) or address
    return bool(mapped.is_loopback)


def _is_special(meant: Address) -> bool:
    """Return whether it is no address of a host in a network, or one that must not be reached by mistake."""
    odd = meant.is_loopback or meant.is_link_local or meant.is_multicast or meant.is_unspecified or meant.is_reserved
    return odd or meant in _THIS_HOST


def _is_public(meant: Address) -> bool:
    if isinstance(meant, IPv6Address) and meant.is_site_local:  # deprecated, and still private where it is used
        return False
    return meant.is_global
