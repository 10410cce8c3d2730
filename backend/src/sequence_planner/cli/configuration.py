"""`configuration`: what `run` would be told by a file and the environment, without running anything."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import AsJson, print_json, refuse
from sequence_planner.cli.surroundings import unfit
from sequence_planner.configuration import FILE, ConfigurationError, configured, read_configuration
from sequence_planner.pipelines.stages.own.confinement import missing

configuration = typer.Typer(
    name="configuration",
    no_args_is_help=True,
    add_completion=False,
    help="Look at what `run` is told by a configuration file and by the environment.",
)
File = Annotated[Path | None, typer.Argument(metavar="[FILE]", envvar=FILE, help="The file.", show_default=False)]


@configuration.command()
def check(file: Annotated[Path, typer.Argument(metavar="FILE", help="The file.")]) -> None:
    """Say what is wrong in a file, with file and line, and whether what it names is there and fit: the model,
    certificates, secrets, the database. The environment is not looked at, and nothing is changed.
    """
    try:
        told, wrong = read_configuration(file, {})
    except ConfigurationError as error:
        refuse(str(error))
    if wrong := [*wrong, *unfit(told)]:
        refuse("\n".join(wrong))
    typer.echo(f"{file} can be used: {', '.join(told) or 'it tells nothing'}")
    if without := missing():
        typer.echo(f"This system cannot keep Python stages from {' and '.join(without)}: see docs/deployment.md.")


@configuration.command()
def show(file: File = None, as_json: AsJson = False) -> None:
    """Print what is told, and where: by the file, and by variables, which come before it. Passwords are left out."""
    try:
        told = configured(file)
    except ConfigurationError as error:
        refuse(str(error))
    if as_json:
        print_json({name: {"value": each.shown, "where": each.where} for name, each in told.items()})
        return
    for name, each in told.items():
        typer.echo(f"{name} = {each.shown}  # {each.where}")
