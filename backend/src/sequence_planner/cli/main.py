"""The command line, a module for each command.

Exit codes: 0 fine, 1 findings, 2 unusable input or surroundings, which are said on standard error.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from sequence_planner.cli.lazy import LazyCommand

# In the order of the help, with what it says of each: the first paragraph of what the command says of itself.
COMMANDS = (
    LazyCommand(
        "new",
        "model.new:new",
        "Write a small station that can be checked and run at once, with comments that say what is what.",
    ),
    LazyCommand(
        "check",
        "model.check:check",
        "Check a model: its documents, its pipelines, that its specifications can be met, "
        "and what is suspicious in it.",
    ),
    LazyCommand(
        "test",
        "model.scenarios:test",
        "Carry out the scenarios of a station, which stand in its `tests`, in simulated time with emulated devices.",
    ),
    LazyCommand(
        "synthesize",
        "model.synthesize:synthesize",
        "Compute the supervisor of a model: how many states can be reached with and without it, "
        "and the guards it adds.",
    ),
    LazyCommand(
        "show",
        "model.show:show",
        "Show what a model means: its variables, ground abilities with their effects, operations and "
        "specifications, and\nthe names that it gives to what is said more than once.",
    ),
    LazyCommand(
        "edit",
        "editing.edit:edit",
        "Change one entry of a station's document, and print the difference. Comments and order stay.",
    ),
    LazyCommand(
        "migrate",
        "editing.migrate:migrate",
        "Show what a station could say shorter with the same meaning, and write what is chosen of it.",
    ),
    LazyCommand(
        "language-server",
        "language_server:language_server",
        "Serve editors that speak the Language Server Protocol, over standard input and output.",
    ),
    LazyCommand(
        "tick", "model.tick:tick", "Take one tick of the reference interpreter, and say what each of its steps did."
    ),
    LazyCommand(
        "plan",
        "model.plan:plan",
        "Plan the goals of operations from the initial state, or from that of --state: what `tick --json` prints.",
    ),
    LazyCommand(
        "recording",
        "recordings.recording:recording",
        "Say what a recording of ROS 2 traffic has for a station, or with --at where the station was at a moment.",
    ),
    LazyCommand(
        "export",
        "model.export:export",
        "Write a model for other tools, as a plain automaton or in CIF; "
        "a station with its ticks by single transitions.",
    ),
    LazyCommand("run", "station.run:run", "Run a station: controller, server and page.", forks=True),
    LazyCommand(
        "configuration",
        "station.configuration:configuration",
        "Look at what `run` is told by a configuration file and by the environment.",
    ),
    LazyCommand(
        "packages",
        "station.packages:packages",
        "Packages of types of resources: bring them, and see what is here.",
    ),
    LazyCommand(
        "messages",
        "model.messages:messages",
        "Write the station's message definitions as packages that colcon builds, for ROS 2 with rclpy.",
    ),
    LazyCommand(
        "security",
        "model.security:security",
        "Write what each node of a station may do on a secured ROS 2 network, as a policy of SROS 2.",
    ),
    LazyCommand(
        "topics",
        "station.topics:topics",
        "Show who and what is on the ROS network: topics with their types, who publishes and subscribes, and services.",
    ),
    LazyCommand(
        "attach",
        "model.attach:attach",
        "Turn a topic of the ROS network into variables of a model: enter it into a resource's document, and check.",
    ),
    LazyCommand(
        "emulate", "station.simulate:emulate_command", "Run emulated devices for a station, in place of real ones."
    ),
    LazyCommand(
        "by-hand", "station.simulate:by_hand", "Move an emulated device by hand, as somebody might move a real one."
    ),
    LazyCommand("fault", "station.simulate:fault", "Let an emulated device have a fault, or end faults."),
    LazyCommand("users", "station.users:users", "Add people who may sign in, and set passwords that were forgotten."),
    LazyCommand(
        "journal",
        "station.journal:journal",
        "Who did what, and what has happened. Without a command it is list, as in: journal MODEL --verify",
    ),
    LazyCommand(
        "backup",
        "station.backup:backup",
        "Write a station's database, revisions and model to one file, while it runs or not.",
    ),
    LazyCommand(
        "restore",
        "station.backup:restore",
        "Put a backup in place where there is no database yet, verify it, and sign everybody out.",
    ),
    LazyCommand("people", "station.users:users", now="users"),
    LazyCommand("controller", "station.controller:controller", hidden=True),
    LazyCommand("server", "station.run:server", hidden=True, imports="server.server"),
)


class _Commands(TyperGroup):
    """All commands; none is imported before it is given."""

    def __init__(self, **settings: Any) -> None:  # noqa: ANN401 (as typer gives them)
        super().__init__(**{**settings, "commands": COMMANDS})


app = typer.Typer(
    cls=_Commands, no_args_is_help=True, add_completion=False, help="Model and control automation stations on ROS 2."
)


def _version(wanted: bool) -> None:
    if wanted:
        from sequence_planner.version import VERSION  # noqa: PLC0415

        typer.echo(f"sequence-planner {VERSION}")
        raise typer.Exit


@app.callback()
def _before_a_command(
    version: Annotated[
        bool, typer.Option("--version", is_eager=True, callback=_version, help="Print the version and end.")
    ] = False,
) -> None:
    """Typer makes a group of what has this, though it knows no command."""


def run(arguments: list[str]) -> None:
    """Run a command line in a process that was forked for it."""
    sys.argv = ["sequence-planner", *arguments]
    main()


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
