"""How it is said that a provider is away, or that what it says is not taken."""

from __future__ import annotations

from sequence_planner.identity.refusal import IdentityRefused


def away(why: str) -> IdentityRefused:
    """The provider is not reached, or does not answer as one does; `why` is for the log as well."""
    detail = f"The provider cannot be used now: {why}. Try again, or sign in with a password if you have one here."
    return IdentityRefused("provider-unavailable", "The provider cannot be used", detail, 503)


def unfit(why: str) -> IdentityRefused:
    """What came from the provider is not taken."""
    detail = f"What came from the provider does not hold: {why}. Begin to sign in again."
    return IdentityRefused("provider-answer-unfit", "Not signed in", detail, 403)


def not_begun() -> IdentityRefused:
    """An answer that nobody waits for here."""
    detail = (
        "This sign-in was not begun in this browser, was finished already, or took longer than ten minutes. "
        "Begin to sign in again."
    )
    return IdentityRefused("sign-in-not-begun", "Not signed in", detail, 403)


def denied(error: str) -> IdentityRefused:
    """The provider let nobody in; `error` is its code (RFC 6749, 4.1.2.1)."""
    detail = f"The provider has signed nobody in ({error}). Begin again, or ask who looks after it."
    return IdentityRefused("provider-refused", "Not signed in", detail, 403)


def no_role() -> IdentityRefused:
    """Somebody whom the station has no role for."""
    detail = "You are known to the provider, but in none of the groups that may use this station. Ask an administrator."
    return IdentityRefused("no-role", "No role here", detail, 403)


def disabled() -> IdentityRefused:
    """Somebody whom an administrator of the station keeps out."""
    detail = "An administrator of this station has disabled your account. Ask there."
    return IdentityRefused("disabled", "Disabled here", detail, 403)
