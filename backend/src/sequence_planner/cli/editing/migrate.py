"""`migrate`: what a station says at length and could say for short, and the writing of what is chosen of that."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer

from sequence_planner.cli.loading import usable_model
from sequence_planner.cli.options import AsJson, StationFolder, print_json, refuse
from sequence_planner.editor.folds.finder import Fold, FoldFinder
from sequence_planner.editor.folds.views import fold_view
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.model.files import Files, read_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.saving import add_file, digest, edit_file

_LONGEST = 60  # characters of what is written now that are shown


def migrate(
    model: StationFolder,
    write: Annotated[
        list[str] | None, typer.Option("--write", metavar="FOLD", help="Write this one; may be given several times.")
    ] = None,
    name: Annotated[
        list[str] | None,
        typer.Option("--name", metavar="FOLD=NAME", help="What is added is called so, and not as is proposed."),
    ] = None,
    json: AsJson = False,
) -> None:
    """Show what a station could say shorter with the same meaning, and write what is chosen of it.

    Each fold is proven: the station is read with it, and its automaton and pipelines are compared with those of now.
    Nothing is written but the folds that --write names by their marks, in that order, all of them or none. Comments
    and whatever else is in the files stay. The exit code is 0, and 2 where a fold cannot be written.
    With --json: {folds: [{id, kind, title, name, places, saved_lines, saved_characters}]}; or {difference}.
    """
    if not model.is_dir():
        refuse(f"{model}: there is no such folder of a station")
    usable_model(model)
    chosen, names = write or [], _names(name or [])
    if strangers := sorted(names.keys() - set(chosen)):
        refuse(f"`{strangers[0]}` is named and not written: add --write {strangers[0]}")
    files = read_files(model)
    known = {file: digest(model / file) for file in files}
    with TemporaryDirectory(prefix="sequence-planner-migrate-") as scratch:
        finder = FoldFinder(Path(scratch))
        if chosen:
            _write(model, files, known, finder, [(each, names.get(each)) for each in chosen], json)
            return
        folds = finder.folds(files).folds
    if json:
        print_json({"folds": [fold_view(each).model_dump(mode="json") for each in folds]})
    else:
        typer.echo("\n".join(_lines(model, folds)))


def _replaced(text: str, _: str) -> str:
    """A file that gets another text, whatever it has."""
    return text


def _names(given: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for each in given:
        fold, equals, name = each.partition("=")
        if not equals or not fold or not name:
            refuse(f"`{each}` is not FOLD=NAME, as in `1c81a640=docked`")
        found[fold] = name
    return found


def _lines(model: Path, folds: list[Fold]) -> Iterator[str]:
    if not folds:
        yield f"{model}: there is nothing that is known to be said shorter"
    for fold in folds:
        yield f"{fold.id}  {fold.title}: {_saved(fold.saved_lines)}"
        for place in fold.places:
            now = f" → {place.now}" if place.now else ""
            yield f"  {model / place.file}:{place.line}:{place.column}: {_short(place.was)}{now}"
    if folds:
        yield f"write one with: sequence-planner migrate {model} --write {folds[0].id}"


def _saved(lines: int) -> str:
    if lines == 0:
        return "as many lines"
    return f"{abs(lines)} line{'' if abs(lines) == 1 else 's'} {'fewer' if lines > 0 else 'more'}"


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 2].rstrip()} …"


@dataclass
class _Writing:
    """The files while one fold after the other is put into them."""

    files: dict[str, str]
    changed: set[str] = field(default_factory=set)

    def put_in(self, changed: Mapping[str, str]) -> None:
        self.files |= changed
        self.changed |= changed.keys()


def _write(
    model: Path,
    files: Files,
    known: Mapping[str, str],
    finder: FoldFinder,
    chosen: list[tuple[str, str | None]],
    json: bool,
) -> None:
    """Write folds into the files, all or none of them; says what is different then."""
    writing = _Writing(dict(files))
    for number, (wanted, name) in enumerate(chosen):
        try:
            writing.put_in(finder.fold(writing.files, wanted, name).files)
        except EditError as error:
            behind = f" (after `{chosen[number - 1][0]}`)" if number else ""
            marks = [fold.id for fold in finder.folds(files).folds]
            near = "" if wanted in marks else suggestion(wanted, marks)
            refuse(f"{error}{behind}{near}; nothing was written")
    try:
        old, new = (sorted(each) for each in (writing.changed & known.keys(), writing.changed - known.keys()))
        for file in old:  # all are as they were, or none is written
            edit_file(model / file, lambda text: text, expected=known[file])
        difference = "".join(add_file(model / file, writing.files[file]) for file in new)
        difference += "".join(
            edit_file(model / file, partial(_replaced, writing.files[file]), expected=known[file]) for file in old
        )
    except EditError as error:
        refuse(str(error))
    if json:
        print_json({"difference": difference})
    else:
        typer.echo(difference, nl=False)
