"""The program `sequence-planner`.

Python runs the script of a program again in each process that it spawns, and so all that the script imports. This
module imports nothing before it is asked to. What a station needs is imported by its fork server: `run` starts that
before all else, even before its own command line is read.
"""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line."""
    if sys.argv[1:2] == ["run"] and "--help" not in sys.argv:
        from sequence_planner.forking.starting import OWN  # noqa: PLC0415
        from sequence_planner.startup.preloads import LATER, NOW  # noqa: PLC0415

        OWN.prepare(NOW, LATER)
    if sys.argv[1:] == ["language-server"]:  # an editor waits, and reading a command line takes a fifth of the time
        from sequence_planner.cli.language_server import language_server  # noqa: PLC0415

        language_server()
    from sequence_planner.cli.main import main as run  # noqa: PLC0415

    run()
