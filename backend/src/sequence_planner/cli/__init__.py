"""The command line, a module for each command.

Exit codes: 0 fine, 1 findings, 2 unusable input or surroundings, which are said on standard error.
"""

from __future__ import annotations

import errno
import io
import os
import sys

import typer

from sequence_planner.cli import journal_replay, running, serving
from sequence_planner.cli.attach import attach
from sequence_planner.cli.check import check
from sequence_planner.cli.edit import edit
from sequence_planner.cli.export import export
from sequence_planner.cli.journal import journal
from sequence_planner.cli.new import new
from sequence_planner.cli.people import people
from sequence_planner.cli.plan import plan
from sequence_planner.cli.show import show
from sequence_planner.cli.synthesize import synthesize
from sequence_planner.cli.tick import tick
from sequence_planner.cli.topics import topics

app = typer.Typer(no_args_is_help=True, add_completion=False, help="Model and control automation stations on ROS 2.")

for command in (
    new,
    check,
    synthesize,
    show,
    edit,
    tick,
    plan,
    export,
    serving.run,
    running.messages,
    topics,
    attach,
):
    app.command()(command)
app.command("emulate")(running.emulate_command)
app.command("by-hand")(running.by_hand)
app.command("fault")(running.fault)
app.add_typer(people, name="people")
journal.command()(journal_replay.replay)
journal.command()(journal_replay.show)
app.add_typer(journal, name="journal")
app.command(hidden=True)(running.controller)
app.command(hidden=True)(serving.server)


def main() -> None:
    """Run the command line. What a terminal cannot show is written as its escape."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        try:
            app()
        finally:
            sys.stdout.flush()  # or what cannot be written is said only when nobody can be told any more
    except OSError as error:
        if error.errno != errno.ENOSPC or error.filename is not None:
            raise
        sys.stderr.write("what was to be printed cannot be written: no space is left\n")
        os.dup2(
            os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno()
        )  # so that Python does not try once more at its end
        sys.exit(2)
