"""`new`: a small station to begin from, or a copy of one of the examples."""

from __future__ import annotations

import re
from importlib.resources import as_file, files
from pathlib import Path
from shutil import copytree
from typing import Annotated

import typer

from sequence_planner.cli.options import AsJson, print_json, refuse
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.model.examples.library import example_files, example_folders, renamed_station
from sequence_planner.model.files import write_files
from sequence_planner.model.json_schema import write_schemas

_NAME = "my_station"


def new(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Where to write it: a new folder, or an empty one.")],
    empty: Annotated[bool, typer.Option("--empty", help="Nothing but its name: to be built in the browser.")] = False,
    example: Annotated[
        str | None, typer.Option("--example", metavar="NAME", help="A copy of the example station of this name.")
    ] = None,
    json: AsJson = False,
) -> None:
    """Write a small station that can be checked and run at once, with comments that say what is what.

    With --example it is one of those that the program comes with, such as truck_engine_station.

    JSON Schemas go to FOLDER/.schemas, so that an editor completes and checks while you type.
    """
    if empty and example is not None:
        refuse("an example is not empty: leave --empty or --example out")
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            refuse(f"{folder} is not empty: name a folder that is new or empty")
        if example is not None:
            _write_example(example, folder)
        elif empty:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "station.yaml").write_text(f"name: {_named_after(folder)}\n", encoding="utf-8")
        else:
            with as_file(files("sequence_planner.cli.model") / "templates" / "station") as template:
                copytree(template, folder, dirs_exist_ok=True)
            station = folder / "station.yaml"
            text = station.read_text(encoding="utf-8")
            station.write_text(text.replace(f"name: {_NAME}", f"name: {_named_after(folder)}"), encoding="utf-8")
        write_schemas(folder / ".schemas")
    except OSError as error:
        refuse(f"{folder} cannot be written: {error.strerror}")
    written = sorted(path for path in folder.rglob("*") if path.is_file() and ".schemas" not in path.parts)
    if json:
        print_json({"folder": str(folder), "files": [str(path) for path in written]})
        return
    for path in written:
        typer.echo(str(path))
    if empty:  # a demonstration would forget the draft
        typer.echo(f"\nNow: sequence-planner run {folder} --emulator")
        return
    run = f"sequence-planner run {folder} --emulator --demonstration"
    typer.echo(f"\nNow: sequence-planner check {folder}\n     sequence-planner test {folder}\n     {run}")


def _write_example(name: str, folder: Path) -> None:
    """Write a copy. Raises `OSError`."""
    folders = example_folders()
    if (found := folders.get(name)) is None:
        known = f"take one of {', '.join(folders)}" if folders else "the program was installed without any"
        refuse(f"there is no example {name!r}: {known}")
    write_files(renamed_station(example_files(found), _named_after(folder)), folder, found)


def _named_after(folder: Path) -> str:
    """A name made from that of the folder, if it can be."""
    name = re.sub(r"\W+", "_", folder.resolve().name, flags=re.ASCII).strip("_").lower()
    return name if re.match(r"[a-z_]", name) and name not in KEYWORDS | {"null"} else _NAME
