"""The provider that people sign in with, and the role that the station gives to each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.auth.roles import Role

NO_OTHERS = "refused"  # what becomes of people in none of the groups, where they are not viewers
MOST_GROUPS = 10_000  # of one person; what has more is not looked at


@dataclass(frozen=True, kw_only=True)
class ProviderSettings:
    """A provider, as the station uses it.

    `groups` is the claim with the groups of a person: its name, or names divided by dots where it is within others.
    `roles` are the groups that have a role; of several the highest counts. `others` is the role of all other people,
    none where they are refused. Without a `secret` the station is a public client, which PKCE alone protects.
    """

    issuer: str
    client: str
    title: str
    roles: tuple[tuple[Role, str], ...]
    secret: str | None = field(default=None, repr=False)
    scopes: tuple[str, ...] = ("openid", "profile")
    groups: str = "groups"
    others: Role | None = None

    def role(self, claims: Mapping[str, object]) -> Role | None:
        """The role of whom the claims are about; None where there is none for that person."""
        theirs = set(groups_of(claims, self.groups))
        having = [role for role, group in self.roles if group in theirs]
        return max(having, key=list(Role).index, default=self.others)

    def says_groups(self, claims: Mapping[str, object]) -> bool:
        """Return whether the claims say anything about groups."""
        return _found(claims, self.groups) is not None


def groups_of(claims: Mapping[str, object], name: str) -> tuple[str, ...]:
    """The groups under this name: a list of texts, or one text. What is neither names no group."""
    found = _found(claims, name)
    if isinstance(found, str):
        return (found,)
    if not isinstance(found, list) or len(found) > MOST_GROUPS:
        return ()
    return tuple(each for each in found if isinstance(each, str))


def _found(claims: Mapping[str, object], name: str) -> object:
    """The claim of this name; else, of `realm_access.roles`, the `roles` within `realm_access`."""
    if name in claims:
        return claims[name]
    found: object = claims
    for part in name.split("."):
        found = found.get(part) if isinstance(found, Mapping) else None
    return found
