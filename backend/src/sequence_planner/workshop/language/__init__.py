"""The language service behind the fields of an editor: what is wrong in a text, what could stand there, what is meant.

The parser and the grounding of the backend are its only authority: what it finds in a text is what they would find.
"""

from sequence_planner.workshop.language.checking import Problem, check
from sequence_planner.workshop.language.completing import complete
from sequence_planner.workshop.language.completion import Completion, Option
from sequence_planner.workshop.language.field import Field, FieldKind
from sequence_planner.workshop.language.formatting import formatted
from sequence_planner.workshop.language.hovering import Hover, hover
from sequence_planner.workshop.language.lexicon import Lexicon
from sequence_planner.workshop.language_view import NameKind

__all__ = [
    "Completion",
    "Field",
    "FieldKind",
    "Hover",
    "Lexicon",
    "NameKind",
    "Option",
    "Problem",
    "check",
    "complete",
    "formatted",
    "hover",
]
