"""`edit`: change one entry of a document, and keep every comment."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory
from typing import Annotated

import typer

from sequence_planner.cli.loading import load_model
from sequence_planner.cli.options import UNUSABLE, StationFolder, refuse
from sequence_planner.model.paths import EditError, parse_path
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.editor import replace
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.model.yaml.saving import digest, edit_file


def edit(
    model: StationFolder,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A file of it, such as resources/robot.yaml.")],
    path: Annotated[str, typer.Argument(metavar="PATH", help="The entry: abilities.move.start.do[0]")],
    value: Annotated[str, typer.Argument(metavar="VALUE", help="Its new value, as YAML.")],
    force: Annotated[bool, typer.Option("--force", help="Write it even if the station is unusable then.")] = False,
) -> None:
    """Change one entry of a station's document, and print the difference. Comments and order stay.

    A change after which the station could not be used is not made, and what would be wrong is said; --force makes it.
    """
    target = (model / file).resolve()
    if not target.is_relative_to(model.resolve()):
        refuse(f"{file} is not in {model}")
    inside = target.relative_to(model.resolve())
    target = model / inside
    if not target.is_file():
        refuse(f"{target}: there is no such file")
    content = _content(value)
    try:
        expected = digest(target)
        wrong = _wrong_after(model, inside, lambda text: replace(text, parse_path(path), content))
        if wrong:
            typer.echo(wrong, err=True)
        if wrong and not force:
            refuse("the station could not be used after this change, so it was not made (--force makes it)")
        difference = edit_file(target, lambda text: replace(text, parse_path(path), content), expected=expected)
    except (EditError, OSError) as error:
        refuse(str(error))
    typer.echo(difference, nl=False)
    if wrong:
        raise typer.Exit(UNUSABLE)


def _content(value: str) -> object:
    """The value as the documents would have it."""
    try:
        document = read_text(f"value: {value}\n", "VALUE").content
    except ModelError:
        document = None
    if not isinstance(document, dict) or len(document) != 1:
        refuse(f"`{value}` is not a value in YAML: quote what has a meaning there")
    if document["value"] is None:
        refuse("an entry without a value means nothing: give it one")
    return document["value"]


def _wrong_after(model: Path, file: Path, change: Callable[[str], str]) -> str:
    """Say what is wrong with the station after a change, tried on a copy; empty if nothing is."""
    with TemporaryDirectory() as scratch:
        copy = copytree(model, Path(scratch) / "station", ignore_dangling_symlinks=True)
        edit_file(copy / file, change)
        try:
            load_model(copy)
        except ModelError as error:
            return str(error).replace(str(copy), str(model))
    return ""
