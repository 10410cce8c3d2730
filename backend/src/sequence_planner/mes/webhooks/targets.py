"""Where webhooks may go: to hosts on a list, by HTTPS, at addresses of the public network.

A name is resolved for each delivery, and the addresses that were found are judged and then connected to, so that what a
name means cannot change in between (DNS rebinding).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, IPv6Network, ip_address
from typing import Final
from urllib.parse import urlsplit

LONGEST_URL: Final = 2000  # characters
_NAT64: Final = IPv6Network("64:ff9b::/96")
_STANDARD_PORTS: Final = {"https": 443, "http": 80}
_VISIBLE: Final = frozenset(map(chr, range(0x21, 0x7F))) - frozenset('\\"<>^`{|}')


class TargetRefused(Exception):
    """Nothing is sent there; the message says why."""


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
    """The hosts that webhooks may go to, each with its port, in small letters and without brackets.

    With `loopback` those of them that are this machine may be reached too, also by HTTP.
    """

    hosts: frozenset[tuple[str, int]] = frozenset()
    loopback: bool = False

    @property
    def written(self) -> list[str]:
        """The list as `host_and_port` reads it."""
        return sorted(f"[{host}]:{port}" if ":" in host else f"{host}:{port}" for host, port in self.hosts)

    def target(self, url: str) -> Target:
        """What a URL names. Raises `TargetRefused` unless it may be sent to, whatever its address will be."""
        target = _read(url)
        if (target.host, target.port) not in self.hosts:
            raise TargetRefused(
                f"{target.host}:{target.port} is not on the list of hosts that webhooks may go to; whoever runs the "
                "station puts it there with --webhook-host"
            )
        if target.scheme != "https" and not self.loopback:
            raise TargetRefused("only https:// is sent to")
        return target

    def judge(self, target: Target, addresses: Sequence[str]) -> None:
        """Raises `TargetRefused` when a target has no address, or one that may not be sent to."""
        for each in addresses:
            address = ip_address(each)
            if _is_loopback(address):
                if not self.loopback:
                    raise TargetRefused(f"{target.host} is this machine ({each}), which is not sent to")
            elif not _is_public(address):
                raise TargetRefused(f"{target.host} has an address that is not public ({each}), which is not sent to")
            elif target.scheme != "https":
                raise TargetRefused(f"{target.host} is not this machine ({each}): only https:// is sent to")
        if not addresses:
            raise TargetRefused(f"{target.host} has no address")


def host_and_port(written: str) -> tuple[str, int]:
    """What `HOST[:PORT]` on the list means; without a port that of HTTPS. Raises `TargetRefused`."""
    target = _read(f"https://{written}/")
    if target.path != "/":
        raise TargetRefused(f"{written!r} is no host; write it as in mes.example:8443")
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
        raise TargetRefused(
            f"this is no URL of the form https://host/path, of up to {LONGEST_URL} characters"
        ) from None
    if "@" in split.netloc:
        raise TargetRefused("a URL with a user or a password in it is not sent to; deliveries are signed")
    if "#" in url:
        raise TargetRefused("a URL with a fragment is not sent to: no server would see it")
    query = f"?{split.query}" if split.query else ""
    return Target(split.scheme, host, port or _STANDARD_PORTS[split.scheme], (split.path or "/") + query)


def _meant(address: IPv4Address | IPv6Address) -> IPv4Address | IPv6Address:
    """The address of IPv4 that one of IPv6 stands for, if it does."""
    if isinstance(address, IPv4Address):
        return address
    if address in _NAT64:
        return IPv4Address(int(address) & 0xFFFFFFFF)
    return address.ipv4_mapped or address.sixtofour or (address.teredo[1] if address.teredo else address)


def _is_loopback(address: IPv4Address | IPv6Address) -> bool:
    mapped = getattr(address, "ipv4_mapped", None) or address
    return bool(mapped.is_loopback)


def _is_public(address: IPv4Address | IPv6Address) -> bool:
    meant = _meant(address)
    if isinstance(meant, IPv6Address) and meant.is_site_local:  # deprecated, and still private where it is used
        return False
    return meant.is_global and not (meant.is_multicast or meant.is_reserved or meant.is_unspecified)
