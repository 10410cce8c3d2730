"""One attempt to deliver something: a POST that is answered with 2xx in time, or the reason why it was not."""

from __future__ import annotations

import asyncio
import socket
import ssl
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from sequence_planner.mes.webhooks.targets import Target, TargetRefused, Targets

if TYPE_CHECKING:
    import httpx

_MOST_ADDRESSES: Final = 3  # that are tried


@dataclass(frozen=True)
class Patience:
    """Seconds for the connection, for each further step, and for all of an attempt."""

    connecting: float = 5.0
    reading: float = 10.0
    all: float = 15.0


class Undelivered(Exception):
    """It was not taken; the message says why."""


async def resolved(targets: Targets, target: Target) -> list[str]:
    """The addresses of a target, each of which may be sent to. Raises `TargetRefused` where one may not, or none is
    found.
    """
    try:
        found = await asyncio.get_running_loop().getaddrinfo(target.host, target.port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        raise TargetRefused(f"{target.host} cannot be resolved") from None
    addresses = list(dict.fromkeys(str(each[4][0]) for each in found))
    targets.judge(target, addresses)
    return addresses


class Sender:
    """Sends to `targets`. No redirect is followed, no proxy and no password of the environment is used."""

    def __init__(self, targets: Targets, patience: Patience | None = None) -> None:
        self._targets = targets
        self._patience = patience or Patience()

    async def post(self, url: str, headers: Mapping[str, str], body: bytes) -> None:
        """Deliver; raises `Undelivered`."""
        try:
            async with asyncio.timeout(self._patience.all):
                await self._post(url, headers, body)
        except TargetRefused as refused:
            raise Undelivered(str(refused)) from None
        except TimeoutError:
            raise Undelivered(f"there was no answer within {self._patience.all:g} s") from None

    async def _post(self, url: str, headers: Mapping[str, str], body: bytes) -> None:
        import httpx  # noqa: PLC0415 - most stations have no webhooks

        target = self._targets.target(url)
        addresses = await resolved(self._targets, target)
        given = {
            **headers,
            "host": target.authority,
            "content-type": "application/json",
            "user-agent": "sequence-planner",
        }
        # The name is checked against the certificate, though the address is connected to.
        named = {"sni_hostname": target.host}
        trouble = ""
        async with self._client() as client:
            for address in addresses[:_MOST_ADDRESSES]:
                request = client.build_request(
                    "POST", target.at(address), headers=given, content=body, extensions=named
                )
                try:
                    return await self._send(client, request)
                except httpx.ConnectError as error:
                    trouble = f"{target.host} cannot be connected to ({_words(error)})"
                except httpx.TimeoutException:
                    trouble = f"{target.host} does not answer in time"
                    break
                except (httpx.HTTPError, httpx.InvalidURL, ssl.SSLError, OSError) as error:
                    trouble = f"{target.host} breaks off ({_words(error)})"
                    break
        raise Undelivered(trouble)

    async def _send(self, client: httpx.AsyncClient, request: httpx.Request) -> None:
        response = await client.send(request, stream=True, follow_redirects=False)
        await response.aclose()  # its status says all; nothing of its body is read
        status = response.status_code
        if not 200 <= status < 300:
            also = "; redirects are not followed" if 300 <= status < 400 else ""
            raise Undelivered(f"it was answered with status {status}{also}")

    def _client(self) -> httpx.AsyncClient:
        """One for each attempt: a connection to an address must not be used again for another name."""
        import httpx  # noqa: PLC0415 - as above

        limits = httpx.Limits(max_connections=1, max_keepalive_connections=0)
        return httpx.AsyncClient(verify=self._trust, trust_env=False, timeout=self._timeout, limits=limits)

    @cached_property
    def _trust(self) -> ssl.SSLContext:
        """What this machine trusts, which a company adds its own authority to."""
        return ssl.create_default_context()

    @cached_property
    def _timeout(self) -> httpx.Timeout:
        import httpx  # noqa: PLC0415 - as above

        return httpx.Timeout(self._patience.reading, connect=self._patience.connecting)


def _words(error: Exception) -> str:
    return str(error)[:200] or type(error).__name__
