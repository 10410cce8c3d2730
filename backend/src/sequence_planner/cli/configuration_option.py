"""The option `--configuration`: a file and the environment tell what the command line leaves out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import WORDING, is_typed, refuse
from sequence_planner.settings import FILE, ConfigurationError, as_told, configured


def _configure(context: typer.Context, file: Path | None) -> Path | None:
    """Read before all other options, which then find there what nobody gave."""
    try:
        told = configured(file)
    except ConfigurationError as error:
        refuse(str(error))
    context.default_map = {name: each.value for name, each in told.items()}

    def worded(message: str) -> str:
        return as_told(message, {name: each.called for name, each in told.items() if not is_typed(context, name)})

    before = WORDING.set(worded)
    context.call_on_close(lambda: WORDING.reset(before))
    return file


ConfigurationOption = Annotated[
    Path | None,
    typer.Option(
        "--configuration",
        envvar=FILE,
        metavar="FILE",
        is_eager=True,
        callback=_configure,
        help="A TOML file with what else would stand here, as in port = 8443; variables such as "
        "SEQUENCE_PLANNER_PORT come before it.",
    ),
]
