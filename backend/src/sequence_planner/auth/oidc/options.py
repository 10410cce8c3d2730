"""The options that name a provider when the station is started, and what keeps a name from being used.

The client's secret is read from a file or from the environment: what stands on a command line everybody on the machine
can read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from sequence_planner.auth.oidc.addresses import LONGEST_ISSUER, is_safe
from sequence_planner.auth.oidc.settings import NO_OTHERS, ProviderSettings
from sequence_planner.auth.roles import Role
from sequence_planner.core.secrets import CLIENT_SECRET

LONGEST_SECRET = 4096
OPENID = "openid"  # the scope without which it is no sign-in (OpenID Connect Core, 3.1.2.1)


class ProviderOptionError(Exception):
    """The provider cannot be used as it is named; the message says what to do. The exit code is 2."""


@dataclass(frozen=True, kw_only=True)
class ProviderOptions:
    """The options of `run` about a provider, as they were given; without `issuer` there is none."""

    issuer: str | None = None
    client: str | None = None
    secret_file: Path | None = None
    title: str | None = None
    scopes: tuple[str, ...] = ()
    groups: str = "groups"
    roles: tuple[str, ...] = ()
    others: str = NO_OTHERS

    def settings(self, environment: Mapping[str, str]) -> ProviderSettings | None:
        """Return what they mean; None without a provider. Raises `ProviderOptionError`."""
        if self.issuer is None:
            if self.client is not None or self.secret_file is not None or self.roles:
                raise ProviderOptionError("--oidc-issuer is missing: it says which provider the others are about")
            return None
        if not self.client:
            raise ProviderOptionError("--oidc-client is missing: the id by which the provider knows this station")
        issuer, roles = _issuer(self.issuer), tuple(_role(each) for each in self.roles)
        others = _others(self.others)
        if not roles and others is None:
            raise ProviderOptionError(
                "nobody of the provider could sign in: say with --oidc-role which group has which role, such as "
                "--oidc-role operator=station-operators, or let all look on with --oidc-others viewer"
            )
        return ProviderSettings(
            issuer=issuer,
            client=self.client,
            secret=self._secret(environment),
            title=self.title or urlsplit(issuer).hostname or issuer,
            scopes=tuple(dict.fromkeys((OPENID, *(self.scopes or ("profile",))))),
            groups=self.groups,
            roles=roles,
            others=others,
        )

    def arguments(self) -> list[str]:
        """The same for another process; the secret is where it was."""
        given = {
            "issuer": self.issuer,
            "client": self.client,
            "client-secret-file": self.secret_file,
            "title": self.title,
            "groups-claim": self.groups,
            "others": self.others,
        }
        options = [f"--oidc-{name}={value}" for name, value in given.items() if value is not None]
        options += [f"--oidc-scope={scope}" for scope in self.scopes]
        return [*options, *(f"--oidc-role={role}" for role in self.roles)] if self.issuer is not None else []

    def _secret(self, environment: Mapping[str, str]) -> str | None:
        if self.secret_file is None:
            return environment.get(CLIENT_SECRET) or None
        if environment.get(CLIENT_SECRET):
            raise ProviderOptionError(
                f"the secret is said twice: in {self.secret_file} and in {CLIENT_SECRET}; keep one"
            )
        try:
            secret = self.secret_file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            why = error.strerror if isinstance(error, OSError) else "it is no text"
            raise ProviderOptionError(
                f"{self.secret_file} cannot be read: {why}; use --oidc-client-secret-file"
            ) from error
        if not 1 <= len(secret) <= LONGEST_SECRET or not secret.isprintable():
            raise ProviderOptionError(f"{self.secret_file} must hold the secret of the client in one line")
        return secret


def _issuer(text: str) -> str:
    parts = urlsplit(text)
    if not is_safe(text) or parts.query or parts.fragment or len(text) > LONGEST_ISSUER:
        raise ProviderOptionError(
            f"{text!r} is no issuer: --oidc-issuer is the address of the provider as it writes it itself, with https "
            "(or http on this machine), without query and fragment"
        )
    return text


def _role(text: str) -> tuple[Role, str]:
    name, _, group = text.partition("=")
    if name not in {each.value for each in Role} or not group:
        raise ProviderOptionError(
            f"{text!r} says no role of a group: use --oidc-role ROLE=GROUP with one of {', '.join(Role)}"
        )
    return Role(name), group


def _others(text: str) -> Role | None:
    if text not in (NO_OTHERS, Role.VIEWER.value):
        raise ProviderOptionError(f"--oidc-others is {NO_OTHERS} or {Role.VIEWER.value}, not {text!r}")
    return None if text == NO_OTHERS else Role.VIEWER
