"""Messages that are made when somebody is told: a program that has nothing to say does without what they need.

It is for what a plan needs at its start, see `tests/core/test_immutable.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sequence_planner.texts.message import Argument, Message


def message(id: str, /, **arguments: Argument) -> Message:
    """A text of the catalogue, with what stands in its places."""
    from sequence_planner.texts.message import Message  # noqa: PLC0415 - see above

    return Message(id, arguments)
