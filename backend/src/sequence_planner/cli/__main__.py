"""`python -m sequence_planner.cli`."""

from sequence_planner.cli.main import main

main()
