"""The ID token of a provider, verified as OpenID Connect Core, 3.1.3.7 says. Asymmetric signatures only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeGuard

from joserfc import jws, jwt
from joserfc.errors import JoseError
from joserfc.jwk import ECKey, JWKRegistry, OKPKey, RSAKey

from sequence_planner.identity.openid.flow import FLOW_LIFE
from sequence_planner.identity.openid.refusals import unfit

ALGORITHMS = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "Ed25519", "EdDSA")
KINDS = ("RSA", "EC", "OKP")  # no shared secret signs for us: whoever checks with it could sign as well
LEEWAY = 60.0  # seconds by which the provider's clock may be ahead of ours or behind
LONGEST_SUBJECT = 255  # characters (OpenID Connect Core, 2)
LONGEST_TOKEN = 64 * 1024  # characters

Key = RSAKey | ECKey | OKPKey


class UnknownKeyError(Exception):
    """The token is signed with a key that is not among those known; there may be new ones."""


@dataclass(frozen=True)
class Expected:
    """What a token must be about."""

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


def verified(token: str, keys: tuple[Key, ...], expected: Expected, now: float) -> dict[str, object]:
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


def _check(claims: Mapping[str, object], expected: Expected, now: float) -> None:
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
    """Whether it is a number of seconds since the epoch."""
    return isinstance(claim, int | float) and not isinstance(claim, bool)
