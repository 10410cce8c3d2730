"""The variables of the environment that hold secrets, so that a process is started with those alone that it needs."""

from __future__ import annotations

import os
from typing import Final

from sequence_planner.core.storage_error import DATABASE

CLIENT_SECRET: Final = "SEQUENCE_PLANNER_OIDC_CLIENT_SECRET"  # of the station, at the provider that people sign in with
PASSWORD: Final = "PGPASSWORD"  # of PostgreSQL's own client
_SECRETS: Final = frozenset({CLIENT_SECRET, PASSWORD, DATABASE})


def environment(*needed: str) -> dict[str, str]:
    """The environment of this process for another one: of its secrets only those that are `needed`."""
    return {name: value for name, value in os.environ.items() if name not in _SECRETS or name in needed}
