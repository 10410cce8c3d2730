"""`export`: a model in the notations of other tools."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.automaton.structure import Automaton
from sequence_planner.cli.loading import usable_model
from sequence_planner.cli.options import AnyModel, refuse
from sequence_planner.exporting.cif import cif_text
from sequence_planner.exporting.efa import efa_text, names_in_document
from sequence_planner.exporting.station import plain_of_station, remarks


class Notation(StrEnum):
    """What a model can be written in."""

    EFA = "efa"
    CIF = "cif"


To = Annotated[Notation, typer.Option("--to", help="efa: a plain automaton (*.efa.json); cif: CIF 3 of Eclipse ESCET.")]
Output = Annotated[Path | None, typer.Option("--output", help="A new file to write it to; else standard output.")]


def export(model: AnyModel, to: To, output: Output = None) -> None:
    """Write a model for other tools, as a plain automaton or in CIF; a station with its ticks by single transitions.

    What differs from the model, and what has another name in a plain automaton, is said on standard error.
    """
    automaton = usable_model(model).automaton
    plain = automaton if automaton.one_at_a_time else plain_of_station(automaton)
    _write(efa_text(plain) if to is Notation.EFA else cif_text(plain), output)
    for remark in remarks(automaton):
        typer.echo(remark, err=True)
    if to is Notation.EFA:
        _say_names(automaton, names_in_document(plain))


def _write(text: str, output: Path | None) -> None:
    if output is None:
        typer.echo(text, nl=False)
        return
    try:
        with output.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        refuse(f"{output} is there already: name a new file")
    except OSError as error:
        refuse(f"{output} cannot be written: {error.strerror}")


def _say_names(automaton: Automaton, written: Mapping[str, str]) -> None:
    for name in automaton.variables:
        if written[name] != name:
            typer.echo(f"`{name}` is called `{written[name]}` there", err=True)
