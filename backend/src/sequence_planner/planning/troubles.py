"""What goes wrong within the planner, for the log."""

from __future__ import annotations


def log(message: str, *arguments: object, trace: bool = False) -> None:
    """Note an error; with `trace`, where the exception that is being handled comes from."""
    # Importing it takes a sixth of the time that importing the planner takes.
    import logging  # noqa: PLC0415

    logging.getLogger(__package__).error(message, *arguments, exc_info=trace)
