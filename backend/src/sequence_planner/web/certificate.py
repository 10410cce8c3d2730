"""The server's own certificate: looked at before anything starts, so that what is wrong is said in plain words.

A handshake in memory finds out what a browser would: whether certificate and key fit together, whether it is valid
today, and whether it is for the names that people open. Only who signed it is not asked: that is between the browser
and its owner.
"""

from __future__ import annotations

import ssl
from collections.abc import Iterable
from pathlib import Path

from sequence_planner.web.settings import SettingsError

# Of OpenSSL's X509_V_ERR_*.
NOT_YET_VALID, EXPIRED, HOST_MISMATCH, ADDRESS_MISMATCH = 9, 10, 62, 64


def server_context(certificate: Path, private_key: Path) -> ssl.SSLContext:
    """What the server speaks TLS with: 1.2 or newer.

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
    """What trusts a server that shows `certificate`, by whatever name, and no other."""
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
