"""`users`: who may sign in, managed on the station's own computer."""

from __future__ import annotations

import contextlib
import getpass
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.cli.lazy import renamed
from sequence_planner.cli.options import AsJson, DatabaseOption, database_url, print_json, refuse
from sequence_planner.core.storage_error import StorageError

if TYPE_CHECKING:
    from sequence_planner.cli.local_users import PeopleAtHand

users = typer.Typer(
    name="users",
    no_args_is_help=True,
    add_completion=False,
    help="Add people who may sign in, and set passwords that were forgotten.",
)

ItsModel = Annotated[
    Path | None, typer.Argument(metavar="[MODEL]", help="The station's folder; not needed with --database.")
]
Name = Annotated[str, typer.Argument(metavar="NAME", help="The person's name.")]
PageUrl = Annotated[str, typer.Option("--url", help="Where the page is.")]


@users.command("list")
def list_users(model: ItsModel = None, database: DatabaseOption = None, json: AsJson = False) -> None:
    """List the people who may sign in, with their roles."""
    with _at_hand(model, database) as at_hand:
        everybody = at_hand.everybody()
    if json:
        print_json({"people": [person.model_dump(mode="json") for person in everybody]})
        return
    width = max((len(person.name) for person in everybody), default=0)
    for person in everybody:
        remarks = [
            remark
            for holds, remark in (
                (person.disabled, "disabled"),
                (person.must_change_password, "has to set a password of their own"),
                (person.issuer is not None, f"signs in with {person.issuer}"),
            )
            if holds
        ]
        typer.echo("  ".join([person.name.ljust(width), person.role.value.ljust(13), ", ".join(remarks)]).rstrip())


@users.command()
def add(
    name: Name,
    role: Annotated[Role, typer.Option(help="What the person may do; each role includes those before it.")],
    model: ItsModel = None,
    database: DatabaseOption = None,
) -> None:
    """Add a person. The password is asked for, and the person has to set another one at the first sign-in.

    Without a terminal it is the first line of standard input.
    """
    with _at_hand(model, database) as at_hand:
        person = at_hand.add(name, role, lambda: _password(name))
    typer.echo(f"{person.name} can sign in as {person.role.value}, and has to set another password then")


@users.command()
def reset(name: Name, model: ItsModel = None, database: DatabaseOption = None) -> None:
    """Set another password for a person who has forgotten it; it has to be changed at the next sign-in.

    All sessions of the person end. Without a terminal the password is the first line of standard input.
    """
    with _at_hand(model, database) as at_hand:
        person = at_hand.reset(name, lambda: _password(name))
    typer.echo(f"{person.name} has to set another password at the next sign-in")
    if person.disabled:
        typer.echo(f"{person.name} is disabled, and cannot sign in until an administrator enables them", err=True)


@users.command()
def setup_link(model: ItsModel = None, database: DatabaseOption = None, url: PageUrl = "http://127.0.0.1:8000") -> None:
    """Print a link with which the first administrator is made: it works once, for 15 minutes. Earlier ones do not."""
    with _at_hand(model, database) as at_hand:
        token = at_hand.link_token()
    typer.echo(f"{url.rstrip('/')}/setup#{token}")


@users.command(hidden=True)
def link(model: ItsModel = None, database: DatabaseOption = None, url: PageUrl = "http://127.0.0.1:8000") -> None:
    """Print the link of `setup-link`, as this is called now."""
    renamed("link", "setup-link")
    setup_link(model, database, url)


@contextlib.contextmanager
def _at_hand(model: Path | None, database: str | None) -> Iterator[PeopleAtHand]:
    """The people of a station; what is refused is said with exit code 2."""
    # Who only checks a model does not wait for a database to be imported.
    from sequence_planner.cli.local_users import people_at_hand  # noqa: PLC0415

    try:
        with people_at_hand(_url(model, database)) as at_hand:
            yield at_hand
    except (IdentityRefused, StorageError) as error:
        refuse(str(error))


def _url(model: Path | None, database: str | None) -> str:
    if model is None:
        return database if database is not None else refuse("say which station: its folder, or --database URL")
    if not (model / "station.yaml").is_file():
        refuse(f"{model}: a station is a folder with a station.yaml: there is none here")
    return database_url(model, database)


def _password(name: str) -> str:
    """Ask for a password twice, or take a line of standard input. It is never an argument, which `ps` would show."""
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\r\n")
    password = getpass.getpass(f"Password for {name}: ")
    if getpass.getpass("The same again: ") != password:
        refuse("the two are not the same, so nothing was changed")
    return password
