"""Binding the server's port, and the rule that keeps what is not encrypted to this machine.

Plain HTTP is spoken on the loopback only. Beyond it the server needs a certificate of its own or a reverse proxy that
has one, and the names by which people open it, so that no foreign name that resolves to it is answered.
"""

from __future__ import annotations

import errno
import socket
from collections.abc import Iterator

from sequence_planner.web.certificate import check_certificate
from sequence_planner.web.settings import LOCALHOST, Endpoint, SettingsError, address_of, split_name

BACKLOG = 128  # connections that wait to be accepted


def check_endpoint(endpoint: Endpoint) -> None:
    """Raise `SettingsError` with all that is wrong, each in a line, unless the server may be reached so.

    Nothing is bound.
    """
    if wrong := list(wrong_with(endpoint)):
        raise SettingsError("\n".join(wrong))


def wrong_with(endpoint: Endpoint) -> Iterator[str]:
    """Why the server may not be reached so; each names the options that it is about."""
    is_address = address_of(endpoint.host) is not None
    if not is_address:
        yield f"{endpoint.host!r} is no address; use --host with {LOCALHOST} or one of this machine"
    elif not (endpoint.loopback or endpoint.https or endpoint.private_key is not None):
        yield (
            f"cannot serve on {endpoint.host} without HTTPS: give --certificate and --private-key, or the --proxy that "
            "has them; without any of these only the loopback is served, see --host"
        )
    if not 1 <= endpoint.port <= 65535:
        yield f"{endpoint.port} is not a port; use --port with a number from 1 to 65535"
    for proxy in endpoint.proxies:
        if address_of(proxy) is None:
            yield f"{proxy!r} is no address; use --proxy with the one that the proxy connects from"
    hosts = []
    for name in endpoint.names:
        try:
            hosts.append(split_name(name)[0])
        except SettingsError as error:
            yield str(error)
    if not endpoint.names and (endpoint.proxies or (is_address and not endpoint.loopback)):
        yield "use --name with the host name by which people open the page; no other is answered"
    if (endpoint.certificate is None) != (endpoint.private_key is None):
        yield "--certificate and --private-key belong together: give both, or none"
    if endpoint.certificate is not None and endpoint.private_key is not None:
        try:  # a proxy may know us by another name
            check_certificate(endpoint.certificate, endpoint.private_key, () if endpoint.proxies else hosts)
        except SettingsError as error:
            yield from str(error).split("\n")


def check_demonstration(endpoint: Endpoint) -> None:
    """Raise `SettingsError` unless `endpoint` is this machine's own, where a demonstration may be given."""
    if endpoint.https or endpoint.names or not endpoint.loopback:
        raise SettingsError(
            "--demonstration is for this machine alone, as nobody signs in: leave it out, or --host (beyond the "
            "loopback), --certificate, --proxy and --name"
        )


def bind(endpoint: Endpoint) -> socket.socket:
    """A socket bound to where `endpoint` listens, so that nobody takes it between check and start.

    The wildcard address `::` listens for IPv4 too. Raises `SettingsError` when the endpoint is not allowed, or its port
    is taken or may not be used.
    """
    check_endpoint(endpoint)
    host = str(address_of(endpoint.host))
    family, kind, protocol, _, address = socket.getaddrinfo(
        host, endpoint.port, type=socket.SOCK_STREAM, flags=socket.AI_NUMERICHOST
    )[0]
    listener = socket.socket(family, kind, protocol)
    # Without it a port stays closed for a minute after a restart; it never lets two servers listen.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if family == socket.AF_INET6:
        listener.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
    try:
        listener.bind(address)
        listener.listen(BACKLOG)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise SettingsError(f"port {endpoint.port} is taken; use --port") from error
        if error.errno == errno.EADDRNOTAVAIL:
            raise SettingsError(f"{endpoint.host} is no address of this machine; use --host") from error
        raise SettingsError(f"port {endpoint.port} cannot be used: {error.strerror}; use --port") from error
    return listener
