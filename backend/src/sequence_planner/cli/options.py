"""The parts that the commands share: their arguments, where the database is, and how they refuse."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextvars import ContextVar
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from sequence_planner.core.storage_error import DATABASE, StorageError
from sequence_planner.db.location import default_url
from sequence_planner.process.memory_limit import LEAST, MOST, USUAL, VARIABLE
from sequence_planner.process.parent_watch import leave_last_words

FINE, FINDINGS, UNUSABLE = 0, 1, 2  # exit codes

StationFolder = Annotated[Path, typer.Argument(metavar="MODEL", help="The station's folder.")]
AnyModel = Annotated[
    Path, typer.Argument(metavar="MODEL", help="A station's folder, or the file of a plain automaton (*.efa.json).")
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON document on standard output, for programs.")]
DatabaseOption = Annotated[
    str | None,
    typer.Option(
        "--database",
        envvar=DATABASE,
        metavar="URL",
        help="Where people, keys and the journal are kept: sqlite:////folder/file or postgresql://user@host/name. "
        "By default a file in the user's state folder, for each station its own.",
    ),
]


Memory = Annotated[
    float,
    typer.Option("--memory", envvar=VARIABLE, metavar="GB", min=LEAST, max=MOST, help="Memory that checks may take."),
]
USUAL_MEMORY = USUAL


def _as_it_is(message: str) -> str:
    return message


# How a refusal is worded: where a configuration has told an option, that is called as it is there.
WORDING: ContextVar[Callable[[str], str]] = ContextVar("wording", default=_as_it_is)


def refuse(message: str, code: int = UNUSABLE) -> NoReturn:
    """Say on standard error what makes the input unusable, and end."""
    message = WORDING.get()(message)
    leave_last_words(message)
    typer.echo(message, err=True)
    raise typer.Exit(code)


def is_typed(context: typer.Context, name: str) -> bool:
    """Return whether an option stands on the command line itself."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def database_url(model: Path, given: str | None) -> str:
    """Return where the database of the station in the folder `model` is."""
    try:
        return default_url(model) if given is None else given
    except StorageError as error:
        refuse(str(error))


def print_json(document: object) -> None:
    """Write one document to standard output."""
    typer.echo(json.dumps(document, indent=2, ensure_ascii=False))
