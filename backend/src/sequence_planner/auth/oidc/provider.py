"""OpenID Connect provider client: discovery, signing keys, code flow with PKCE, ID token validation."""

from __future__ import annotations

import asyncio
import json
import ssl
import time
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TypeGuard
from urllib.parse import quote, urlencode

import httpx
import structlog
from joserfc import jws, jwt
from joserfc.errors import JoseError
from joserfc.jwk import ECKey, JWKRegistry, OKPKey, RSAKey

from sequence_planner.auth.oidc.addresses import is_safe
from sequence_planner.auth.oidc.flow import FLOW_LIFE, ProviderAnswer, SignInFlow
from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.texts.message import message

# How it is said that a provider is away, or that what it says is not taken.


def away(why: str) -> IdentityRefused:
    """The provider is not reached, or does not answer as one does; `why` is for the log as well."""
    return IdentityRefused("provider-unavailable", message("refused.provider-unavailable.why", why=why), 503)


def unfit(why: str) -> IdentityRefused:
    """Return the refusal that says that what came from the provider is not taken."""
    return IdentityRefused("provider-answer-invalid", message("refused.provider-answer-invalid.why", why=why), 403)


def not_begun() -> IdentityRefused:
    """An answer that nobody waits for here."""
    return IdentityRefused("sign-in-not-begun", message("refused.sign-in-not-begun.again"), 403)


def denied(error: str) -> IdentityRefused:
    """The provider let nobody in; `error` is its code (RFC 6749, 4.1.2.1)."""
    return IdentityRefused("provider-refused", message("refused.provider-refused.code", code=error), 403)


def no_role() -> IdentityRefused:
    """Somebody whom the station has no role for."""
    return IdentityRefused("no-role", message("refused.no-role.ask"), 403)


def disabled() -> IdentityRefused:
    """Somebody whom an administrator of the station keeps out."""
    return IdentityRefused("disabled", message("refused.disabled.ask"), 403)


# Asking a provider over HTTP: in bounded time, for answers of bounded length, and never on to another address.

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


# The ID token of a provider, verified as OpenID Connect Core, 3.1.3.7 says. Asymmetric signatures only.

ALGORITHMS = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "Ed25519", "EdDSA")
KINDS = ("RSA", "EC", "OKP")  # no shared secret signs for us: whoever checks with it could sign as well
LEEWAY = 60.0  # seconds by which the provider's clock may be ahead of ours or behind
LONGEST_SUBJECT = 255  # characters (OpenID Connect Core, 2)
LONGEST_TOKEN = 64 * 1024  # characters

Key = RSAKey | ECKey | OKPKey


class UnknownKeyError(Exception):
    """The token is signed with a key that is not among those known; there may be new ones."""


@dataclass(frozen=True)
class ExpectedClaims:
    """The claims that a token must be about."""

    issuer: str
    client: str
    nonce: str


def signing_keys(document: Mapping[str, object]) -> tuple[Key, ...]:
    """The keys of a JWK set that can sign for us; others, and those that nobody understands, are left out."""
    listed = document.get("keys")
    return tuple(_keys(listed)) if isinstance(listed, list) else ()


def _keys(listed: Iterable[object]) -> Iterable[Key]:
    for each in listed:
        if not isinstance(each, dict) or each.get("kty") not in KINDS or each.get("use", "sig") != "sig":
            continue
        try:
            key = JWKRegistry.import_key(each)
        except (JoseError, ValueError, TypeError, KeyError):
            continue
        if isinstance(key, RSAKey | ECKey | OKPKey):
            yield key


def verified(token: str, keys: tuple[Key, ...], expected: ExpectedClaims, now: float) -> dict[str, object]:
    """The claims of a token. Raises `IdentityRefused` where it does not hold, and `UnknownKeyError`."""
    if len(token) > LONGEST_TOKEN:
        raise unfit("its token is too long")
    try:
        header = jws.extract_compact(token.encode()).headers()
    except (JoseError, ValueError, UnicodeError) as error:
        raise unfit("its token cannot be read") from error
    if header.get("alg") not in ALGORITHMS:
        raise unfit("its token is not signed as it must be")
    try:
        found = jwt.decode(token, _key(keys, header.get("kid")), algorithms=list(ALGORITHMS))
    except (JoseError, ValueError, TypeError) as error:
        raise unfit("the signature of its token is wrong") from error
    claims = dict(found.claims)
    _check(claims, expected, now)
    return claims


def _key(keys: tuple[Key, ...], kid: object) -> Key:
    """The key of this id; of a provider with a single one the token need not name it."""
    found = [key for key in keys if key.kid == kid] if kid is not None else list(keys)
    if len(found) != 1:
        raise UnknownKeyError
    return found[0]


def _check(claims: Mapping[str, object], expected: ExpectedClaims, now: float) -> None:
    audience = claims.get("aud")
    audiences = [audience] if isinstance(audience, str) else audience
    subject, expires, issued = claims.get("sub"), claims.get("exp"), claims.get("iat")
    if claims.get("iss") != expected.issuer:
        raise unfit("its token is of another issuer")
    if not isinstance(audiences, list) or expected.client not in audiences:
        raise unfit("its token is for another client")
    if claims.get("azp", expected.client) != expected.client or (len(audiences) > 1 and "azp" not in claims):
        raise unfit("its token was made out to another client")
    if not isinstance(subject, str) or not 1 <= len(subject) <= LONGEST_SUBJECT or not subject.isprintable():
        raise unfit("its token does not say whom it is about")
    if claims.get("nonce") != expected.nonce:
        raise unfit("its token belongs to another sign-in")
    if not _is_time(expires) or expires <= now - LEEWAY:
        raise unfit("its token has expired; look at the clocks of both machines")
    if not _is_time(issued) or issued > now + LEEWAY:
        raise unfit("its token is of a time to come; look at the clocks of both machines")
    if "nbf" in claims and (not _is_time(before := claims["nbf"]) or before > now + LEEWAY):
        raise unfit("its token is not valid yet; look at the clocks of both machines")
    if "auth_time" in claims and (not _is_time(was := claims["auth_time"]) or was < now - FLOW_LIFE - LEEWAY):
        raise unfit("whoever it is about has signed in there some time ago, and not now")


def _is_time(claim: object) -> TypeGuard[float]:
    """Return whether it is a number of seconds since the epoch."""
    return isinstance(claim, int | float) and not isinstance(claim, bool)


# What a provider says of itself (OpenID Connect Discovery 1.0), and its keys, kept for a while.

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
    """Return what a discovery document says. Raises `IdentityRefused` (`provider-unavailable`) where it cannot be
    used.
    """
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


class DiscoveryCache:
    """The things known of the provider at `issuer`. What cannot be asked for again stays as it was."""

    def __init__(self, issuer: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._issuer = issuer
        self._clock = clock
        self._metadata: tuple[float, Metadata] | None = None
        self._keys: tuple[float, tuple[Key, ...]] | None = None

    @property
    def last(self) -> Metadata | None:
        """The metadata that was said last; nothing is asked for."""
        return None if self._metadata is None else self._metadata[1]

    async def metadata(self) -> Metadata:
        """Return what the provider says of itself. Raises `IdentityRefused` (`provider-unavailable`)."""
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


# A provider of OpenID Connect: where it is asked who somebody is, and what it says (authorization code flow, PKCE).

NAMES = (
    "preferred_username",
    "name",
    "nickname",
    "email",
)  # claims that may name somebody, the best first
OUR_FAULT = ("invalid_client", "unauthorized_client", "unsupported_grant_type", "invalid_scope")


class Provider:
    """The provider that `settings` name."""

    def __init__(self, settings: ProviderSettings) -> None:
        self.settings = settings
        self._known = DiscoveryCache(settings.issuer)

    async def address(self, flow: SignInFlow, back: str) -> str:
        """Return where the browser is sent to sign in; it comes back to the address `back`. Raises
        `IdentityRefused`.
        """
        asked_for = {
            "response_type": "code",
            "client_id": self.settings.client,
            "redirect_uri": back,
            "scope": " ".join(self.settings.scopes),
            "state": flow.state,
            "nonce": flow.nonce,
            "code_challenge": flow.challenge,
            "code_challenge_method": "S256",
            "prompt": "login",  # the browser may still be known there, and somebody else be at it
        }
        return _with((await self._known.metadata()).authorization, asked_for)

    def end_address(self, home: str) -> str | None:
        """Return where one signs out of the provider as well, and then comes to `home`; None where that is not
        known.
        """
        known = self._known.last
        if known is None or known.end_session is None:
            return None
        return _with(known.end_session, {"client_id": self.settings.client, "post_logout_redirect_uri": home})

    async def claims(self, answer: ProviderAnswer, flow: SignInFlow, back: str, now: float) -> dict[str, object]:
        """Return what the provider says about who signed in. Raises `IdentityRefused` where that does not hold."""
        metadata = await self._known.metadata()
        if answer.issuer not in ({self.settings.issuer} if metadata.names_issuer else {self.settings.issuer, None}):
            raise unfit("another provider has answered")
        if answer.error is not None or answer.code is None:
            raise denied(answer.error or "no code")
        said = await self._redeem(metadata, answer.code, flow, back)
        token = said.get("id_token")
        if not isinstance(token, str):
            raise unfit("it gave no ID token")
        claims = await self._verified(
            token, ExpectedClaims(self.settings.issuer, self.settings.client, flow.nonce), now
        )
        told = self.settings.says_groups(claims) and any(name in claims for name in NAMES)
        access = said.get("access_token")
        if told or metadata.userinfo is None or not isinstance(access, str) or not access.isprintable():
            return claims
        return {**await self._more(metadata.userinfo, access, claims["sub"]), **claims}

    async def _redeem(self, metadata: Metadata, code: str, flow: SignInFlow, back: str) -> Mapping[str, object]:
        """Return what the provider gives for a code."""
        form = {
            "grant_type": "authorization_code",
            "code": code,
            "redirect_uri": back,
            "client_id": self.settings.client,
            "code_verifier": flow.verifier,
        }
        headers = {}
        if (secret := self.settings.secret) is not None and metadata.posts_secret:
            form["client_secret"] = secret
        elif secret is not None:  # each encoded as in a form (RFC 6749, 2.3.1)
            pair = f"{quote(self.settings.client, safe='')}:{quote(secret, safe='')}"
            headers["Authorization"] = f"Basic {b64encode(pair.encode()).decode()}"
        status, said = await asked("POST", metadata.token, headers=headers, form=form)
        if status == 200:
            return said
        error = said.get("error")
        LOG.warning("the provider gives nothing for a code", status=status, error=error)
        if error in OUR_FAULT:
            raise away("it does not take this station for the client that it is named as; its administrator can tell")
        raise unfit("it does not know the code, or no longer")

    async def _verified(self, token: str, expected: ExpectedClaims, now: float) -> dict[str, object]:
        try:
            return verified(token, await self._known.keys(), expected, now)
        except UnknownKeyError:
            LOG.info("the provider signs with a key that is not known yet")
        try:
            return verified(token, await self._known.keys(anew=True), expected, now)
        except UnknownKeyError as error:
            raise unfit("its token is signed with a key that is none of its own") from error

    async def _more(self, url: str, access: str, subject: object) -> dict[str, object]:
        """Return what the provider says beside the token; it must be about the same person (OpenID Connect Core,
        5.3.2).
        """
        status, said = await asked("GET", url, headers={"Authorization": f"Bearer {access}"})
        if status != 200 or said.get("sub") != subject:
            raise unfit("what it says beside its token is about somebody else, or nothing")
        return said


def names_in(claims: Mapping[str, object]) -> tuple[str, ...]:
    """Return what somebody may be called, the best first."""
    found = (claims.get(name) for name in NAMES)
    return tuple(each for each in found if isinstance(each, str) and each)


def _with(url: str, parameters: Mapping[str, str]) -> str:
    joint = "&" if "?" in url else "?"
    return f"{url}{joint}{urlencode(parameters, quote_via=quote)}"
