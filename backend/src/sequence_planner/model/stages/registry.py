"""All kinds of stages, and one of them as an entry of a pipeline."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Field, ModelWrapValidatorHandler, PlainSerializer, PrivateAttr, model_validator
from pydantic.fields import FieldInfo

from sequence_planner.language.types import Place
from sequence_planner.model.fields import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages import discretise, expression, map, match, python, rename, timing
from sequence_planner.model.stages.base import Context, Stage, StageDeclaration
from sequence_planner.model.stages.marks import NameUse
from sequence_planner.texts.message import message

FAMILIES = (rename, expression, discretise, map, match, timing, python)
KINDS: dict[str, type[StageDeclaration]] = {}


class StageDocument(DocumentPart):
    """One stage of a pipeline: exactly one kind. Fields and variables of one name are mapped without being asked."""

    _place: Place = PrivateAttr(default=Place("", 1, 1))

    @model_validator(mode="wrap")
    @classmethod
    def _one_kind(cls, written: object, handler: ModelWrapValidatorHandler[StageDocument]) -> StageDocument:
        """Exactly one key, whose place is that of the stage."""
        stage = handler(written)
        if len(stage.model_fields_set) != 1:
            raise ValueError(message("form.stage", kinds=", ".join(cls.model_fields)))
        if isinstance(written, dict) and isinstance(key := next(iter(written)), SourceText):
            stage._place = key.place
        return stage

    @classmethod
    def of(cls, declaration: StageDeclaration) -> StageDocument:
        """A stage that nobody has written."""
        return cls.model_construct({declaration.kind}, **{declaration.kind: declaration})

    @property
    def kind(self) -> str:
        """The key, such as `discretise`."""
        return next(iter(self.model_fields_set))

    @property
    def content(self) -> StageDeclaration:
        """The stage itself."""
        found: StageDeclaration = getattr(self, self.kind)
        return found

    @property
    def place(self) -> Place:
        """The place where the key was written."""
        return self._place

    def named(self, is_incoming: bool, *uses: NameUse) -> list[SourceText]:
        """The names of which the stage makes one of these uses."""
        return self.content.named(self.content, is_incoming, *uses)

    def check(self, context: Context) -> Stage | None:
        """The stage where it stands; None after all that is wrong with it has been noted in `context`."""
        return self.content.check(context)


def add_kind(declaration: type[StageDeclaration]) -> None:
    """Have a kind of stage as a key of `StageDocument`, before the first one is read.

    Raises `ValueError` if another one has that key.
    """
    if KINDS.get(declaration.kind, declaration) is not declaration:
        raise ValueError(f"there is a stage `{declaration.kind}` already: {KINDS[declaration.kind].__qualname__}")
    written: Any = declaration
    if declaration.is_bare:
        ((name, info),) = declaration.model_fields.items()

        def put(content: object) -> StageDeclaration:
            return declaration.model_construct({name}, **{name: content})

        def taken(content: object) -> object:
            return getattr(content, name)

        written = Annotated[info.rebuild_annotation(), AfterValidator(put), PlainSerializer(taken)]
    given: Any = Given
    field = FieldInfo.from_annotated_attribute(given[written], Field(default=None, description=declaration.about))
    StageDocument.__pydantic_fields__[declaration.kind] = field
    KINDS[declaration.kind] = declaration


for _family in FAMILIES:
    for _each in vars(_family).values():
        if isinstance(_each, type) and issubclass(_each, StageDeclaration) and hasattr(_each, "kind"):
            add_kind(_each)
