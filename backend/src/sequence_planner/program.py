"""The program `sequence-planner`.

Python runs the script of a program again in each process that it spawns, and so all that the script imports. This
module imports nothing before it is asked to.
"""

from __future__ import annotations


def main() -> None:
    """Run the command line."""
    from sequence_planner.cli import main as run  # noqa: PLC0415

    run()
