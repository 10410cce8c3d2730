"""A station at one moment of its editing: its files as typed, and what their names mean as far as that can be said."""

from __future__ import annotations

from dataclasses import dataclass, field

from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.symbols.texts import ModelContent
from sequence_planner.model.files import Files
from sequence_planner.ros.types.messages import MessageRegistry


@dataclass(frozen=True)
class StationSnapshot:
    """The files after change `number`, and the meaning of names then or shortly before.

    A file that cannot be read counts there as it was when it could be.
    """

    number: int
    files: Files
    lexicon: Lexicon
    messages: MessageRegistry | None
    content: ModelContent = field(repr=False)
