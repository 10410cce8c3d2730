"""Port binding of the server: loopback rule for unencrypted connections, TLS certificate check."""

from __future__ import annotations

import errno
import socket
import ssl
from collections.abc import Iterable, Iterator
from pathlib import Path

from sequence_planner.server.settings import LOCALHOST, Endpoint, SettingsError, address_of, origin_of, split_name

# The server's own certificate: looked at before anything starts, so that what is wrong is said in plain words.
#
# A handshake in memory finds out what a browser would: whether certificate and key fit together, whether it is valid
# today, and whether it is for the names that people open. Only who signed it is not asked: that is between the browser
# and its owner.

# Of OpenSSL's X509_V_ERR_*.
NOT_YET_VALID, EXPIRED, HOST_MISMATCH, ADDRESS_MISMATCH = 9, 10, 62, 64


def server_context(certificate: Path, private_key: Path) -> ssl.SSLContext:
    """Return what the server speaks TLS with: 1.2 or newer.

    Raises `SettingsError` when the files cannot be read, are not PEM, do not fit together, or need a passphrase.
    """
    wrong = []
    for path, option in ((certificate, "--certificate"), (private_key, "--private-key")):
        try:
            path.read_bytes()
        except OSError as error:
            wrong.append(f"{path} cannot be read: {error.strerror}; use {option}")
    if wrong:
        raise SettingsError("\n".join(wrong))
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(certificate, private_key, password=_no_passphrase)
    except _Locked as error:
        raise SettingsError(
            f"{private_key} is locked with a passphrase, which nobody could type when the station starts by itself; "
            "give --private-key one without, readable by this user only"
        ) from error
    except ssl.SSLError as error:
        if error.reason == "KEY_VALUES_MISMATCH":
            raise SettingsError(
                f"{private_key} is not the private key of {certificate}: see --private-key and --certificate"
            ) from error
        raise SettingsError(
            f"{certificate} and {private_key} cannot be used: both must be PEM files "
            f"({error.reason or error.args[0]}), see --certificate and --private-key"
        ) from error
    return context


def trusting_context(certificate: Path) -> ssl.SSLContext:
    """Return what trusts a server that shows `certificate`, by whatever name, and no other."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    context.load_verify_locations(certificate)
    return context


def check_certificate(certificate: Path, private_key: Path, names: Iterable[str]) -> None:
    """Raise `SettingsError` unless a browser that trusts it would open each of `names` with it today."""
    server = server_context(certificate, private_key)
    client = trusting_context(certificate)
    _check_as_browser(certificate, client, server, None)
    client.check_hostname = True
    for name in names:
        _check_as_browser(certificate, client, server, name.strip("[]"))


def _check_as_browser(certificate: Path, client: ssl.SSLContext, server: ssl.SSLContext, name: str | None) -> None:
    try:
        _shake_hands(client, server, name)
    except ssl.SSLCertVerificationError as error:
        if error.verify_code == EXPIRED:
            reason = "has expired; renew it, see --certificate"
        elif error.verify_code == NOT_YET_VALID:
            reason = "is not valid yet; look at its dates, see --certificate, and at this machine's clock"
        elif error.verify_code in (HOST_MISMATCH, ADDRESS_MISMATCH):
            reason = f"is not for {name}: its subject alternative names must have what --name says"
        else:
            reason = f"would be refused by browsers, see --certificate: {error.verify_message}"
        raise SettingsError(f"the certificate {certificate} {reason}") from error
    except ssl.SSLError as error:
        raise SettingsError(
            f"the certificate {certificate} cannot be used, see --certificate: {error.reason or error.args[0]}"
        ) from error


def _shake_hands(client: ssl.SSLContext, server: ssl.SSLContext, name: str | None) -> None:
    """A handshake between the two, without a network. Raises `ssl.SSLError` when the client would not go on."""
    to_client, to_server = ssl.MemoryBIO(), ssl.MemoryBIO()
    asking = client.wrap_bio(to_client, to_server, server_hostname=name)
    answering = server.wrap_bio(to_server, to_client, server_side=True)
    while not _goes_on(asking):
        _goes_on(answering)


def _goes_on(side: ssl.SSLObject) -> bool:
    """Take the handshake as far as what has come allows; whether it is complete."""
    try:
        side.do_handshake()
    except ssl.SSLWantReadError:
        return False
    return True


class _Locked(Exception):
    """The private key needs a passphrase."""


def _no_passphrase() -> str:
    raise _Locked


# Binding the server's port, and the rule that keeps what is not encrypted to this machine.
#
# Plain HTTP is spoken on the loopback only. Beyond it the server needs a certificate of its own or a reverse proxy that
# has one, and the names by which people open it, so that no foreign name that resolves to it is answered.

BACKLOG = 128  # connections that wait to be accepted


def check_endpoint(endpoint: Endpoint) -> None:
    """Raise `SettingsError` with all that is wrong, each in a line, unless the server may be reached so.

    Nothing is bound.
    """
    if wrong := list(wrong_with(endpoint)):
        raise SettingsError("\n".join(wrong))


def wrong_with(endpoint: Endpoint) -> Iterator[str]:
    """Yield the reasons why the server may not be reached so; each names the options that it is about."""
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
    for url in endpoint.wall_beside:
        try:
            origin = origin_of(url)
        except SettingsError as error:
            yield str(error)
        else:
            if endpoint.https and not origin.startswith("https:"):
                yield f"{url!r} is no HTTPS, and browsers show nothing else in a page that is; use --wall-beside with https://"
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
