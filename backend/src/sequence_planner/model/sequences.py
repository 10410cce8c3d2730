"""Document schemas of sequences of operations: what comes after what, at the same time, or in place of what."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from sequence_planner.language.names.suggestions import nearest
from sequence_planner.model.fields import DocumentPart, Given, Words, main_text
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

SequenceKind = Literal["sequence", "parallel", "alternative", "arbitrary"]
KINDS: tuple[SequenceKind, ...] = ("sequence", "parallel", "alternative", "arbitrary")
_FORMS = "an operation such as `tighten(left)`, or `{sequence: [...]}`, `parallel`, `alternative` or `arbitrary`"


def _form_of_branch(content: object) -> str | None:
    if isinstance(content, dict | SequencePart):
        return "part"
    return "operation" if isinstance(content, str) else None


def _form_of_branches(content: object) -> str | None:
    return "list" if isinstance(content, list) else _form_of_branch(content)


Branch = Annotated[
    Annotated[SourceText, Tag("operation")] | Annotated["SequencePart", Tag("part")],
    Discriminator(_form_of_branch, "branch", _FORMS),
]
Branches = Annotated[
    Annotated[list[Branch], Field(min_length=1), Tag("list")]
    | Annotated[SourceText, Tag("operation")]
    | Annotated["SequencePart", Tag("part")],
    Discriminator(_form_of_branches, "branches", f"a list, each entry {_FORMS}"),
]


class SequencePart(DocumentPart):
    """Operations, and parts of them again, in a `sequence`, in `parallel`, as `alternative` or in `arbitrary` order."""

    each: dict[SourceText, SourceText] = Field(default_factory=dict, alias="for")
    """What stands here once per value of an enumeration, in order: `{pair: bolt_pair}`."""
    sequence: Given[Branches] = None
    """One after the other, in this order."""
    parallel: Given[Branches] = None
    """All of them, none of which waits for another."""
    alternative: Given[Branches] = None
    """One of them: the first, as they are written, that can begin."""
    arbitrary: Given[Branches] = None
    """All of them, one at a time, in any order."""

    @model_validator(mode="after")
    def _one_order(self) -> SequencePart:
        if len(self._kinds) > 1 or (self._needs_kind and not self._kinds):
            raise ValueError(message("form.sequence", kinds=", ".join(KINDS)))
        if self.each and not self._kinds:
            raise ValueError(message("form.for"))
        return self

    @property
    def kind(self) -> SequenceKind | None:
        """The way its branches are ordered; None where there are none."""
        return next(iter(self._kinds), None)

    @property
    def branches(self) -> list[SourceText | SequencePart]:
        """The parts that it orders, as they are written; each stands for one per value of `each`."""
        found: list[SourceText | SequencePart] | SourceText | SequencePart
        found = next((getattr(self, kind) for kind in self._kinds), [])
        return found if isinstance(found, list) else [found]

    @property
    def _needs_kind(self) -> bool:
        return True

    @property
    def _kinds(self) -> list[SequenceKind]:
        return [kind for kind in KINDS if getattr(self, kind) is not None]


class TitledDocument(DocumentPart):
    """Something that people know by a title."""

    title: Given[Words] = None
    """For people."""

    @property
    def main_title(self) -> SourceText | None:
        """The title as it stands in records."""
        return main_text(self.title)


class SequenceDocument(SequencePart, TitledDocument):
    """A sequence of operations, an entry beside them: it orders them, and other sequences can use it by its name."""


def is_sequence(content: object) -> bool:
    """Return whether an entry of `operations.yaml` is meant as a sequence, and as no operation."""
    if not isinstance(content, dict) or any(key in content for key in ("precondition", "goal")):
        return False
    return any(key in KINDS or nearest(str(key), KINDS, 0.75) is not None for key in content)
