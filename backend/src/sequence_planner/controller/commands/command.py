"""The bases of all commands and queries. Each declares once its fields, its routes and who may give or ask it; of a
command also what is recorded, of a query what answers it.

Whoever adds one writes its class beside those of the same subject, and a method for it in a feature (`handles`,
`answers`).
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Generic, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt, StrictStr

from sequence_planner.core.actor import Actor
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.data_models import DataModel
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.texts.refused import Refused

LARGEST_REVISION = 2**53 - 1  # the largest whole number that every JSON reader keeps

Why = Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]
Revision = Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]
GivenValue = StrictBool | StrictInt | StrictStr
LONGEST_PREDICATE = 4000  # characters
Predicate = Annotated[str, Field(min_length=1, max_length=LONGEST_PREDICATE)]
Answer = TypeVar("Answer", bound=DataModel)
GivenValues = Annotated[dict[str, GivenValue], Field(min_length=1, max_length=200)]


@dataclass(frozen=True)
class Route:
    """A route of the REST interface, on which a command is given or a query asked.

    `path` names some of its fields, the body has the others, or the query string where there is no body.

    `operation` is what generated clients call it, `body` the name of the body's schema, which has the reason where one
    `may_say_why`. `text` is what the route does where that is not the docstring of the command or query. `role` is the
    least role of a person (`auth.roles.Role`); keys may read what viewers may, and with `watch` watches may use it as
    well, for tasks of their resource. `types` are those of fields that are narrower on this route, `names` what fields
    are called in the address where that is not their name.
    """

    method: Literal["GET", "POST", "PUT", "DELETE"]
    path: str
    operation: str
    tag: str
    body: str = ""
    body_text: str = ""
    text: str = ""
    role: Literal["viewer", "operator", "engineer"] = "operator"
    watch: bool = False
    may_say_why: bool = True
    refusals: tuple[int, ...] = (409, 504)
    types: Mapping[str, Any] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)


class Command(DataModel):
    """`actor` is who asks, `reason` why, in that person's words. `subject` is on what it acts, for the record.

    What moves devices is for the one session in control. `harmless` is what only ever stops them: it is carried out
    even where it cannot be recorded. `kind` is what the record calls it, for good. Who gives it is answered with the
    document that it `makes`, where it makes one.
    """

    routes: ClassVar[tuple[Route, ...]] = ()
    for_control: ClassVar[bool] = False
    about: ClassVar[str] = ""  # its subject, with its fields in braces
    makes: ClassVar[type[DataModel] | None] = None
    actor: Actor
    reason: str | None = Field(default=None, max_length=LONGEST_REASON)
    kind: str

    @property
    def needs_control(self) -> bool:
        """True if its actor must be in control."""
        return self.for_control

    @property
    def overtaken_by_pause(self) -> bool:
        """True if it is void where somebody pauses the station while it waits for its record."""
        return self.needs_control

    @property
    def harmless(self) -> bool:
        """True if it can only bring devices to rest."""
        return False

    @property
    def subject(self) -> str:
        """On what it acts, for the record."""
        return self.about.format_map(self.__dict__)

    @property
    def for_two(self) -> Collection[str]:
        """The variables that it writes, of which some may ask for a second person's approval."""
        return ()


class Query(DataModel, Generic[Answer]):
    """What the controller tells only to who asks, with a document of its `answer_type`. It changes nothing.

    Who asks waits for `patience` seconds at most, where it is null as long as for a command; what is found later is
    dropped.
    """

    routes: ClassVar[tuple[Route, ...]] = ()
    patience: ClassVar[float | None] = None
    kind: str

    @classmethod
    def answer_type(cls) -> type[Answer]:
        """The kind of document that answers it."""
        for base in cls.__mro__:
            if issubclass(base, BaseModel) and (arguments := base.__pydantic_generic_metadata__["args"]):
                found: type[Answer] = arguments[0]
                return found
        raise TypeError(f"{cls.__name__} does not say what answers it")


class TextPlace(BaseModel):
    """What is wrong within a text that was sent, and where: from `start` to before `end`, in Unicode characters."""

    model_config = ConfigDict(frozen=True)
    start: int
    end: int
    message: str


class CommandRefused(Refused):
    """The controller does not carry out a command. `place` is where a text cannot be read."""

    def __init__(
        self,
        slug: str,
        detail: str,
        status: int = 409,
        *,
        title: str | None = None,
        place: TextPlace | None = None,
    ) -> None:
        super().__init__(slug, detail, status, title=title)
        self.place = place


# Who carries out a command, and who answers a query: methods of features, which `bus` finds.

Given = TypeVar("Given", bound=Command)
Asked = TypeVar("Asked", bound=Query[Any])
Made = TypeVar("Made", bound=DataModel | None)
Told = TypeVar("Told", bound=DataModel | Awaitable[DataModel])
Feature = TypeVar("Feature")
HANDLES = "_handles"  # of a function: the command that it handles, or the query that it answers


def handles(
    command: type[Given],
) -> Callable[[Callable[[Feature, Given, Timestamp], Made]], Callable[[Feature, Given, Timestamp], Made]]:
    """Declare that a method carries out a command, now, and returns what that makes. It raises `CommandRefused`, and
    nothing has changed then.
    """

    def declare(method: Callable[[Feature, Given, Timestamp], Made]) -> Callable[[Feature, Given, Timestamp], Made]:
        setattr(method, HANDLES, command)
        return method

    return declare


def answers(query: type[Asked]) -> Callable[[Callable[[Feature, Asked], Told]], Callable[[Feature, Asked], Told]]:
    """Declare that a method answers a query, at once or after a while. It raises `CommandRefused`.

    The event loop is not held up: what takes long is awaited, and done in another process.
    """

    def declare(method: Callable[[Feature, Asked], Told]) -> Callable[[Feature, Asked], Told]:
        setattr(method, HANDLES, query)
        return method

    return declare
