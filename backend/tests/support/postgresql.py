"""A PostgreSQL server of the tests' own: real, in a temporary folder, reached by a socket there."""

from __future__ import annotations

import os
import pwd
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path

import psycopg
from sqlalchemy import URL

USER, PASSWORD = "station", "not@so/secret:%"
WHAT_TO_DO = "PostgreSQL's programs are not here: sudo apt-get install postgresql"

_PROGRAMS = ("initdb", "pg_ctl", "pg_dump", "pg_restore")
_INSTALLED = Path("/usr/lib/postgresql")
_UNPRIVILEGED = "nobody"  # PostgreSQL refuses to run as root


@dataclass(frozen=True)
class Server:
    """A running server; `folder` is where its socket is."""

    folder: Path
    names: Iterator[int]

    def url(self, database: str = "postgres", password: str = PASSWORD) -> str:
        """The URL of a database of it."""
        made = URL.create("postgresql", USER, password, database=database, query={"host": str(self.folder)})
        return made.render_as_string(hide_password=False)

    def new_database(self) -> str:
        """The URL of a database that is new and empty."""
        name = f"station_{next(self.names)}"
        with psycopg.connect(
            host=str(self.folder), user=USER, password=PASSWORD, dbname="postgres", autocommit=True
        ) as connection:
            connection.execute(f"CREATE DATABASE {name}")
        return self.url(name)


def binaries() -> Path | None:
    """The folder of initdb, pg_ctl and the others; None where there is none."""
    found = shutil.which("initdb")
    folders = [Path(found).resolve().parent] if found else []
    folders += sorted(_INSTALLED.glob("*/bin"), key=lambda folder: float(folder.parent.name), reverse=True)
    return next((folder for folder in folders if all((folder / name).exists() for name in _PROGRAMS)), None)


@contextmanager
def running_server(programs: Path) -> Iterator[Server]:
    """A server that runs until the block ends."""
    folder = Path(tempfile.mkdtemp(prefix="sequence-planner-postgresql-"))
    user = _UNPRIVILEGED if os.geteuid() == 0 else None
    if user is not None:
        shutil.chown(folder, user, pwd.getpwnam(user).pw_gid)
    data, password, log = folder / "data", folder / "password", folder / "log"

    def program(name: str, *arguments: str | Path) -> None:
        subprocess.run(
            [programs / name, "-D", data, *arguments],
            cwd=folder,
            user=user,
            check=True,
            timeout=120,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )

    password.write_text(PASSWORD, encoding="utf-8")
    password.chmod(0o644)
    options = f"-c listen_addresses= -c unix_socket_directories={folder} -c fsync=off"
    initial = ("-U", USER, f"--pwfile={password}", "--auth=scram-sha-256", "--encoding=UTF8", "--locale=C", "--no-sync")
    try:
        with _ended_with_us(programs, folder, user):
            program("initdb", *initial)
            program("pg_ctl", "-w", "-t", "60", "-l", log, "-o", options, "start")
            yield Server(folder, count())
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _ended_with_us(programs: Path, folder: Path, user: str | None) -> Iterator[None]:
    """End the server with the block, and also if these tests are killed: then the pipe that they hold is closed."""
    script = 'cat; "$0" -D "$1/data" -w -m immediate stop; rm -rf "$1"'
    ending = subprocess.Popen(
        ["sh", "-c", script, programs / "pg_ctl", folder],
        cwd=folder,
        user=user,
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield
    finally:
        ending.communicate(timeout=60)
