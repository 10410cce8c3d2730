"""One sign-in under way: what ties the provider's answer to the browser in which it was begun.

The browser keeps a token in a cookie. State, nonce and the verifier of PKCE are made from it, each under its own label,
so that nobody finds one from another, and the station keeps only a hash of the token.
"""

from __future__ import annotations

import hmac
from base64 import urlsafe_b64encode
from dataclasses import dataclass
from hashlib import sha256

from sequence_planner.auth.tokens import new_token

FLOW_LIFE = 600.0  # seconds in which the provider has to answer


@dataclass(frozen=True)
class SignInFlow:
    """The values that follow from the `token` of one sign-in."""

    token: str

    @classmethod
    def begin(cls) -> SignInFlow:
        """One that nobody can guess."""
        return cls(new_token())

    @property
    def state(self) -> str:
        """The value that the provider gives back, so that no other page's answer is taken (RFC 6749, 10.12)."""
        return self._made("state")

    @property
    def nonce(self) -> str:
        """The value that the ID token repeats, so that none of another sign-in is taken (OpenID Connect Core,
        15.5.2).
        """
        return self._made("nonce")

    @property
    def verifier(self) -> str:
        """The proof that who shows the code has asked for it (RFC 7636)."""
        return self._made("verifier")

    @property
    def challenge(self) -> str:
        """The value by which the provider is told of the verifier beforehand."""
        return _text(sha256(self.verifier.encode()).digest())

    def is_state(self, state: str) -> bool:
        """Return whether an answer belongs to this sign-in, found out in a time that does not tell where it differs."""
        return hmac.compare_digest(self.state.encode(), state.encode("utf-8", "surrogatepass"))

    def _made(self, label: str) -> str:
        token = self.token.encode("utf-8", "surrogatepass")
        return _text(hmac.digest(token, f"sign-in {label}".encode(), "sha256"))


def _text(digest: bytes) -> str:
    return urlsafe_b64encode(digest).rstrip(b"=").decode()


@dataclass(frozen=True)
class ProviderAnswer:
    """The answer that the browser brought back from the provider."""

    state: str
    code: str | None = None
    error: str | None = None
    issuer: str | None = None
