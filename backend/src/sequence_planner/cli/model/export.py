"""`export`: a model in the notations of other tools."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.tick import synchronise
from sequence_planner.cli.analysing import supervisor_of
from sequence_planner.cli.initial_state import StateFile, moment
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.cli.options import AnyModel, refuse
from sequence_planner.export.cif import cif_text
from sequence_planner.export.efa import efa_text, names_in_document, plain_of_station, remarks
from sequence_planner.export.pddl import pddl_text
from sequence_planner.export.sequential import ExportError, sequential
from sequence_planner.export.smv import smv_text
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.planning.problem import Goal, goals_of
from sequence_planner.planning.single.derived import for_planning
from sequence_planner.synthesis.supervisor import SynthesisError


class Notation(StrEnum):
    """A notation that a model can be written in."""

    EFA = "efa"
    CIF = "cif"
    PDDL = "pddl"
    SMV = "smv"


To = Annotated[
    Notation,
    typer.Option(
        "--to",
        help="efa: a plain automaton (*.efa.json); cif: CIF 3 of Eclipse ESCET; pddl: for planners; smv: for nuXmv.",
    ),
]
Output = Annotated[
    Path | None,
    typer.Option("--output", help="A new file to write it to; else standard output. PDDL's problem is put beside it."),
]
GoalTexts = Annotated[
    list[str] | None,
    typer.Option(
        "--goal", metavar="EXPR", help="For pddl and smv: a predicate to reach; else all operations. Repeatable."
    ),
]


def export(model: AnyModel, to: To, output: Output = None, goal: GoalTexts = None, state: StateFile = None) -> None:
    """Write a model for other tools, as a plain automaton or in CIF; a station with its ticks by single transitions.

    What differs from the model, and what has another name in a plain automaton, is said on standard error. PDDL and
    SMV ask how goals are reached from the initial state, or from that of --state: what `tick --json` prints.
    """
    automaton = usable_automaton(model)
    if to in (Notation.PDDL, Notation.SMV):
        _write_question(automaton, to, goal or [], state, output)
        return
    if goal or state is not None:
        refuse("--goal and --state belong to a question: write it with --to pddl or smv")
    plain = automaton if automaton.one_at_a_time else plain_of_station(automaton)
    _write(efa_text(plain) if to is Notation.EFA else cif_text(plain), output)
    for remark in remarks(automaton):
        typer.echo(remark, err=True)
    if to is Notation.EFA:
        _say_names(automaton, names_in_document(plain))


def _write_question(
    automaton: Automaton, to: Notation, texts: Sequence[str], state: str | None, output: Path | None
) -> None:
    """A module of SMV; or a domain of PDDL, and the problem in a file beside it, or behind it."""
    before = moment(automaton, state)
    try:
        supervisor = supervisor_of(automaton)
        goals = tuple(_goal(automaton, text) for text in texts) or goals_of(automaton, automaton.operations)
        if not goals:
            refuse("the model has no goal of its own: name one with --goal")
        station, begin = automaton, before.state
        if automaton.one_at_a_time:
            station = for_planning(automaton)
            begin = synchronise(station, {**dict.fromkeys(station.types), **before.state})
        question = sequential(station, supervisor, begin, goals)
        if to is Notation.SMV:
            _write(smv_text(question), output)
            return
        text = pddl_text(question)
    except (SynthesisError, ExportError) as error:
        refuse(str(error))
    _write(text.domain, output)
    _write(text.problem, None if output is None else output.with_suffix(f".problem{output.suffix}"))


def _goal(automaton: Automaton, text: str) -> Goal:
    try:
        return Goal(text, automaton.read_condition(text))
    except ExpressionError as error:
        refuse(f"--goal {text!r}: {error.message}")


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
