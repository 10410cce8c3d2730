"""PostgreSQL's own programs, with which its databases are copied: this machine needs its client."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from sequence_planner.backup.trouble import BackupError, Trouble
from sequence_planner.secret_variables import PASSWORD, environment
from sequence_planner.storage.address import PostgresqlServer

_INSTALLED: Final = Path("/usr/lib/postgresql")  # where Debian has the programs, by version


def run(name: str, server: PostgresqlServer, *options: str) -> None:
    """Run `pg_dump` or `pg_restore` on a database. Raises `StorageError` with what it says.

    The password goes by the environment: everybody on this machine can read what stands on a command line.
    """
    from psycopg.conninfo import make_conninfo  # noqa: PLC0415 - stations with SQLite do without

    url = server.url
    words = {"host": url.host, "port": url.port, "user": url.username, "dbname": url.database, **url.query}
    told = make_conninfo(**{name: str(value) for name, value in words.items() if value})
    secret = {} if url.password is None else {"PGPASSWORD": str(url.password)}
    _run(str(server), name, [f"--dbname={told}", "--no-password", *options], secret)


def read_through(dump: Path) -> None:
    """Read what `pg_dump` has written to its end. Raises `StorageError` where that cannot be done."""
    _run(str(dump), "pg_restore", [f"--file={os.devnull}", str(dump)], {})


def _run(of: str, name: str, arguments: Sequence[str], secret: Mapping[str, str]) -> None:
    done = subprocess.run(
        [program(name), *arguments],
        env={**environment(PASSWORD), **secret, "LC_ALL": "C"},  # what it says of a full disk is looked for
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"it ended with code {done.returncode}"]
        full = any(os.strerror(errno.ENOSPC) in line for line in said)
        raise BackupError(Trouble.NO_SPACE if full else Trouble.OTHER, f"{of}: {name} failed: {'; '.join(said[:3])}")


def program(name: str) -> Path:
    """The newest there is: it can speak to all servers that are no newer. Raises `BackupError`."""
    by_version = sorted(_INSTALLED.glob(f"*/bin/{name}"), key=lambda file: float(file.parents[1].name), reverse=True)
    found = by_version[0] if by_version else shutil.which(name)
    if found is None:
        raise BackupError(
            Trouble.NO_PROGRAM,
            f"{name} is not here, which copies a database of PostgreSQL: install its client, as in "
            "sudo apt-get install postgresql-client",
        )
    return Path(found)
