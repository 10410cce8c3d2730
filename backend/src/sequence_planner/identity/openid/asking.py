"""Asking a provider over HTTP: in bounded time, for answers of bounded length, and never on to another address."""

from __future__ import annotations

import asyncio
import json
import ssl
from collections.abc import Mapping
from functools import cache

import httpx
import structlog

from sequence_planner.identity.openid.refusals import away

LOG = structlog.get_logger(__name__)
PATIENCE = 8.0  # seconds for one answer, all in all
LARGEST = 512 * 1024  # bytes


@cache
def _trusted() -> ssl.SSLContext:
    """The authorities of this machine; `SSL_CERT_FILE` names others, as for any program with OpenSSL."""
    return ssl.create_default_context()


async def asked(
    method: str, url: str, *, headers: Mapping[str, str] | None = None, form: Mapping[str, str] | None = None
) -> tuple[int, dict[str, object]]:
    """The status of an answer, and the JSON object that it is. Raises `IdentityRefused` (`provider-unavailable`)."""
    try:
        async with (
            asyncio.timeout(PATIENCE),
            httpx.AsyncClient(verify=_trusted(), follow_redirects=False) as client,
            client.stream(method, url, headers={"Accept": "application/json", **(headers or {})}, data=form) as answer,
        ):
            body = b""
            async for part in answer.aiter_bytes():
                body += part
                if len(body) > LARGEST:
                    raise _away(url, f"its answer has more than {LARGEST} bytes")
            status = answer.status_code
    except TimeoutError as error:
        raise _away(url, f"it does not answer within {PATIENCE:g} s") from error
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        LOG.warning("the provider is not reached", url=url, reason=str(error) or repr(error))
        raise away("it is not reached") from error
    if status >= 500:
        raise _away(url, f"it answers with status {status}")
    try:
        found = json.loads(body)
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise _away(url, f"its answer with status {status} cannot be read")
    return status, found


def _away(url: str, why: str) -> Exception:
    LOG.warning("the provider does not answer as one does", url=url, reason=why)
    return away(why)
