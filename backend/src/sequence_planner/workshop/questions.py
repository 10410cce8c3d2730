"""What is asked about texts of the draft while they are written, and what is answered."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from sequence_planner.control.view_part import View
from sequence_planner.workshop.edits import FilePath, Steps
from sequence_planner.workshop.language_view import CompletionView, HoverView, ProblemView

LONGEST_TEXT = 20_000  # characters


class LanguageQuestionKind(StrEnum):
    """What can be asked about a text."""

    CHECK = "check"
    COMPLETION = "completion"
    HOVER = "hover"
    FORMAT = "format"


class TextAt(BaseModel):
    """A text that stands, or shall stand, at the entry `path` of a file.

    `parameters` are those of its ability, operation or specification, by name with their enumerations, where it is so
    new that the draft does not have it yet.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    file: FilePath
    path: Annotated[Steps, Field(min_length=1)]
    text: Annotated[str, Field(max_length=LONGEST_TEXT)]
    parameters: dict[str, str] | None = Field(default=None, max_length=20)


class PlaceInText(TextAt):
    """A place in it, counted in characters from its beginning."""

    offset: Annotated[int, Field(ge=0, le=LONGEST_TEXT, strict=True)]


class ProblemsView(View):
    """What is wrong with a text; nothing where it is none that names stand in."""

    problems: tuple[ProblemView, ...]


class HoverAnswer(View):
    """What stands at the place; null where no name does."""

    hover: HoverView | None


class FormatView(View):
    """The text as it is written best, with the same meaning."""

    text: str


LanguageAnswer = ProblemsView | CompletionView | HoverAnswer | FormatView
