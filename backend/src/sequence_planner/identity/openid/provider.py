"""A provider of OpenID Connect: where it is asked who somebody is, and what it says (authorization code flow, PKCE)."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping
from urllib.parse import quote, urlencode

import structlog

from sequence_planner.identity.openid.asking import asked
from sequence_planner.identity.openid.flow import Answer, Flow
from sequence_planner.identity.openid.id_token import Expected, UnknownKeyError, verified
from sequence_planner.identity.openid.metadata import Known, Metadata
from sequence_planner.identity.openid.refusals import away, denied, unfit
from sequence_planner.identity.openid.settings import ProviderSettings

LOG = structlog.get_logger(__name__)
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
        self._known = Known(settings.issuer)

    async def address(self, flow: Flow, back: str) -> str:
        """Where the browser is sent to sign in; it comes back to the address `back`. Raises `IdentityRefused`."""
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
        """Where one signs out of the provider as well, and then comes to `home`; None where that is not known."""
        known = self._known.last
        if known is None or known.end_session is None:
            return None
        return _with(known.end_session, {"client_id": self.settings.client, "post_logout_redirect_uri": home})

    async def claims(self, answer: Answer, flow: Flow, back: str, now: float) -> dict[str, object]:
        """What the provider says about who signed in. Raises `IdentityRefused` where that does not hold."""
        metadata = await self._known.metadata()
        if answer.issuer not in ({self.settings.issuer} if metadata.names_issuer else {self.settings.issuer, None}):
            raise unfit("another provider has answered")
        if answer.error is not None or answer.code is None:
            raise denied(answer.error or "no code")
        said = await self._redeem(metadata, answer.code, flow, back)
        token = said.get("id_token")
        if not isinstance(token, str):
            raise unfit("it gave no ID token")
        claims = await self._verified(token, Expected(self.settings.issuer, self.settings.client, flow.nonce), now)
        told = self.settings.says_groups(claims) and any(name in claims for name in NAMES)
        access = said.get("access_token")
        if told or metadata.userinfo is None or not isinstance(access, str) or not access.isprintable():
            return claims
        return {**await self._more(metadata.userinfo, access, claims["sub"]), **claims}

    async def _redeem(self, metadata: Metadata, code: str, flow: Flow, back: str) -> Mapping[str, object]:
        """What the provider gives for a code."""
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

    async def _verified(self, token: str, expected: Expected, now: float) -> dict[str, object]:
        try:
            return verified(token, await self._known.keys(), expected, now)
        except UnknownKeyError:
            LOG.info("the provider signs with a key that is not known yet")
        try:
            return verified(token, await self._known.keys(anew=True), expected, now)
        except UnknownKeyError as error:
            raise unfit("its token is signed with a key that is none of its own") from error

    async def _more(self, url: str, access: str, subject: object) -> dict[str, object]:
        """What the provider says beside the token; it must be about the same person (OpenID Connect Core, 5.3.2)."""
        status, said = await asked("GET", url, headers={"Authorization": f"Bearer {access}"})
        if status != 200 or said.get("sub") != subject:
            raise unfit("what it says beside its token is about somebody else, or nothing")
        return said


def names_in(claims: Mapping[str, object]) -> tuple[str, ...]:
    """What somebody may be called, the best first."""
    found = (claims.get(name) for name in NAMES)
    return tuple(each for each in found if isinstance(each, str) and each)


def _with(url: str, parameters: Mapping[str, str]) -> str:
    joint = "&" if "?" in url else "?"
    return f"{url}{joint}{urlencode(parameters, quote_via=quote)}"
