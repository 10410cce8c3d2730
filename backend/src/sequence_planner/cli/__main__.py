"""`python -m sequence_planner.cli`."""

from sequence_planner.cli import main

main()
