"""Commands are imported when they are given, and the help says of each what it says of itself."""

from __future__ import annotations

import subprocess
import sys

import pytest

from sequence_planner.cli.lazy import LazyCommand
from sequence_planner.cli.main import COMMANDS


@pytest.mark.parametrize("put_off", COMMANDS, ids=lambda each: each.name)
def test_the_help_says_of_a_command_what_it_says_of_itself(put_off: LazyCommand) -> None:
    command = put_off.command()
    assert command.name == (put_off.now or put_off.name)
    if not put_off.hidden:
        assert put_off.short_help == command.help.partition("\n\n")[0]


def test_the_help_imports_no_command() -> None:
    code = (
        "import sys; sys.argv = ['sequence-planner', '--help']\n"
        "from sequence_planner.cli.main import main\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "print('imported:', *sorted(name for name in sys.modules if name.startswith('sequence_planner.')))"
    )
    printed = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    ).stdout
    assert "Run a station" in printed
    few = ("cli", "cli.lazy", "cli.main", "process", "process.gc_tuning")
    assert printed.splitlines()[-1] == " ".join(["imported:", *(f"sequence_planner.{each}" for each in few)])
