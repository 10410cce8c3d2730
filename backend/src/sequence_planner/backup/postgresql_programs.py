"""PostgreSQL's own programs, with which its databases are copied: this machine needs its client."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from typing import Final

from psycopg.conninfo import make_conninfo

from sequence_planner.storage.address import PostgresqlServer
from sequence_planner.storage.error import StorageError

_INSTALLED: Final = Path("/usr/lib/postgresql")  # where Debian has the programs, by version


def run(name: str, server: PostgresqlServer, *options: str) -> None:
    """Run `pg_dump` or `pg_restore` on a database. Raises `StorageError` with what it says.

    The password goes by the environment: everybody on this machine can read what stands on a command line.
    """
    url = server.url
    words = {"host": url.host, "port": url.port, "user": url.username, "dbname": url.database, **url.query}
    told = make_conninfo(**{name: str(value) for name, value in words.items() if value})
    secret = {} if url.password is None else {"PGPASSWORD": str(url.password)}
    done = subprocess.run(
        [_program(name), f"--dbname={told}", "--no-password", *options],
        env={**os.environ, **secret},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"it ended with code {done.returncode}"]
        raise StorageError(f"{server}: {name} failed: {'; '.join(said[:3])}")


def _program(name: str) -> Path:
    """The newest there is: it can speak to all servers that are no newer."""
    by_version = sorted(_INSTALLED.glob(f"*/bin/{name}"), key=lambda file: float(file.parents[1].name), reverse=True)
    found = by_version[0] if by_version else shutil.which(name)
    if found is None:
        raise StorageError(
            f"{name} is not here, which copies a database of PostgreSQL: install its client, as in "
            "sudo apt-get install postgresql-client"
        )
    return Path(found)
