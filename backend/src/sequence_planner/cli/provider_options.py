"""The options of `run` about the provider with which people sign in, and what they mean."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

PREFIX = "SEQUENCE_PLANNER_OIDC_"

Issuer = Annotated[
    str | None,
    typer.Option(
        "--oidc-issuer",
        envvar=f"{PREFIX}ISSUER",
        metavar="URL",
        help="Let people sign in with this provider of OpenID Connect, beside passwords.",
    ),
]
Client = Annotated[
    str | None,
    typer.Option(
        "--oidc-client",
        envvar=f"{PREFIX}CLIENT",
        metavar="ID",
        help="As which client the provider knows this station.",
    ),
]
SecretFile = Annotated[
    Path | None,
    typer.Option(
        "--oidc-client-secret-file",
        envvar=f"{PREFIX}CLIENT_SECRET_FILE",
        metavar="FILE",
        help=f"Where the client's secret is, in one line; or it is in the variable {PREFIX}CLIENT_SECRET.",
    ),
]
Title = Annotated[
    str | None,
    typer.Option(
        "--oidc-title",
        envvar=f"{PREFIX}TITLE",
        metavar="TEXT",
        help="What people call the provider; else its host name.",
    ),
]
Scopes = Annotated[
    list[str] | None,
    typer.Option(
        "--oidc-scope",
        envvar=f"{PREFIX}SCOPE",
        metavar="SCOPE",
        help="What is asked for beside openid; can be repeated. By default profile.",
    ),
]
Groups = Annotated[
    str,
    typer.Option(
        "--oidc-groups-claim",
        envvar=f"{PREFIX}GROUPS_CLAIM",
        metavar="CLAIM",
        help="The claim with a person's groups, as in realm_access.roles.",
    ),
]
Roles = Annotated[
    list[str] | None,
    typer.Option(
        "--oidc-role",
        envvar=f"{PREFIX}ROLE",
        metavar="ROLE=GROUP",
        help="The role here of people in a group there; can be repeated, and of several the highest counts.",
    ),
]
Others = Annotated[
    str,
    typer.Option(
        "--oidc-others",
        envvar=f"{PREFIX}OTHERS",
        metavar="refused|viewer",
        help="What becomes of people in none of these groups.",
    ),
]
