"""What a provider says of itself (OpenID Connect Discovery 1.0), and its keys, kept for a while."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import structlog

from sequence_planner.identity.openid.addresses import is_safe
from sequence_planner.identity.openid.asking import asked
from sequence_planner.identity.openid.id_token import Key, signing_keys
from sequence_planner.identity.openid.refusals import away
from sequence_planner.identity.refusal import IdentityRefused

LOG = structlog.get_logger(__name__)
KEPT = 3600.0  # seconds after which it is asked for again
KEYS_AGAIN = 10.0  # seconds between two questions for keys, however many tokens name unknown ones


@dataclass(frozen=True)
class Metadata:
    """The addresses of a provider, and what it can do."""

    authorization: str
    token: str
    keys: str
    userinfo: str | None
    end_session: str | None
    posts_secret: bool  # the client's secret is sent in the form, not in a header
    names_issuer: bool  # answers to the browser name the issuer (RFC 9207)


def read_metadata(document: dict[str, object], issuer: str) -> Metadata:
    """What a discovery document says. Raises `IdentityRefused` (`provider-unavailable`) where it cannot be used."""
    if document.get("issuer") != issuer:
        raise _unusable("it says that it is another issuer than the one that was named")
    methods = document.get("code_challenge_methods_supported")
    if isinstance(methods, list) and "S256" not in methods:
        raise _unusable("it does not know PKCE with S256")
    ways = document.get("token_endpoint_auth_methods_supported")
    ways = ways if isinstance(ways, list) else ["client_secret_basic"]
    return Metadata(
        authorization=_address(document, "authorization_endpoint"),
        token=_address(document, "token_endpoint"),
        keys=_address(document, "jwks_uri"),
        userinfo=_address(document, "userinfo_endpoint") if "userinfo_endpoint" in document else None,
        end_session=_address(document, "end_session_endpoint") if "end_session_endpoint" in document else None,
        posts_secret="client_secret_basic" not in ways and "client_secret_post" in ways,
        names_issuer=document.get("authorization_response_iss_parameter_supported") is True,
    )


class Known:
    """What is known of the provider at `issuer`. What cannot be asked for again stays as it was."""

    def __init__(self, issuer: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._issuer = issuer
        self._clock = clock
        self._metadata: tuple[float, Metadata] | None = None
        self._keys: tuple[float, tuple[Key, ...]] | None = None

    @property
    def last(self) -> Metadata | None:
        """What was said last; nothing is asked for."""
        return None if self._metadata is None else self._metadata[1]

    async def metadata(self) -> Metadata:
        """What the provider says of itself. Raises `IdentityRefused` (`provider-unavailable`)."""
        if self._metadata is not None and self._clock() < self._metadata[0] + KEPT:
            return self._metadata[1]
        try:
            status, document = await asked("GET", f"{self._issuer.rstrip('/')}/.well-known/openid-configuration")
            if status != 200:
                raise _unusable(f"it does not describe itself (status {status})")
            self._metadata = (self._clock(), read_metadata(document, self._issuer))
        except IdentityRefused:
            if self._metadata is None:
                raise
        return self._metadata[1]

    async def keys(self, *, anew: bool = False) -> tuple[Key, ...]:
        """The keys it signs with; `anew` where a token names one that is not among them."""
        asked_at = None if self._keys is None else self._keys[0]
        patience = KEYS_AGAIN if anew else KEPT
        if self._keys is not None and asked_at is not None and self._clock() < asked_at + patience:
            return self._keys[1]
        try:
            status, document = await asked("GET", (await self.metadata()).keys)
            if status != 200:
                raise _unusable(f"it does not tell its keys (status {status})")
            self._keys = (self._clock(), signing_keys(document))
        except IdentityRefused:
            if self._keys is None or anew:
                raise
        return self._keys[1]


def _address(document: dict[str, object], name: str) -> str:
    found = document.get(name)
    if not isinstance(found, str) or not is_safe(found):
        raise _unusable(f"its {name} is no address that can be asked safely")
    return found


def _unusable(why: str) -> IdentityRefused:
    LOG.warning("the provider cannot be used", reason=why)
    return away(why)
