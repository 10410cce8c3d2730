"""The outline of a first station: its devices, its product and the steps that make it, and what must never be."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.message import Message

Name = Annotated[str, Field(max_length=100)]
Title = Annotated[str, Field(max_length=200)]
Angle = Annotated[float, Field(ge=-1e6, le=1e6)]


class OutlineItem(DataModel):
    """Base of all that has a name in the model, and a title for people; without one they read the name."""

    name: Name
    title: Title = ""


class Pose(OutlineItem):
    """A pose of a robot. `joints` are its angles in rad or m, as many in each pose; none where the robot itself knows
    its poses by their names.
    """

    joints: Annotated[tuple[Angle, ...], Field(max_length=32)] = ()


class Robot(OutlineItem):
    """A robot that is sent to named poses, of which the first is where it rests. It goes from any to any, or along
    the row.
    """

    kind: Literal["robot"] = "robot"
    poses: Annotated[tuple[Pose, ...], Field(max_length=60)]
    ways: Literal["any", "row"] = "any"


class Tool(OutlineItem):
    """A tool that is told to run and says when it is done, such as a nutrunner or a glue gun."""

    kind: Literal["tool"] = "tool"


class Clamp(OutlineItem):
    """A device that opens and closes and says in which of both it is, such as a clamp, a gripper or a door. It rests
    open.
    """

    kind: Literal["clamp"] = "clamp"


class PersonDevice(OutlineItem):
    """A person with a watch, who is asked for tasks and acknowledges them."""

    kind: Literal["person"] = "person"


class FoundDevice(OutlineItem):
    """A device that is on the ROS network: it gets the `topics` that are named, and its abilities later."""

    kind: Literal["found"] = "found"
    topics: Annotated[tuple[Annotated[str, Field(max_length=200)], ...], Field(max_length=50)] = ()


Device = Annotated[Robot | Tool | Clamp | PersonDevice | FoundDevice, Field(discriminator="kind")]


class Stand(DataModel):
    """A robot in one of its poses."""

    robot: Name
    pose: Name


class OutlineStep(OutlineItem):
    """What brings the product from one of its states to the next one: the device that does it, for a clamp whether it
    opens or closes, and where robots stand meanwhile.
    """

    by: Name
    action: Literal["open", "close"] | None = None
    where: Annotated[tuple[Stand, ...], Field(max_length=10)] = ()


class Product(OutlineItem):
    """What is made: its states in order, and a step between each and the next. When it is done the next one comes by
    itself (`next`), with an order (`order`), or none does (`once`).
    """

    states: Annotated[tuple[OutlineItem, ...], Field(max_length=40)]
    steps: Annotated[tuple[OutlineStep, ...], Field(max_length=39)]
    then: Literal["next", "order", "once"] = "next"


class Fact(DataModel):
    """That a thing is, or is not, so: a device or the product in a `value`, as `things` of an `OutlineView` has them;
    or a step, which is `under_way`.
    """

    thing: Annotated[str, Field(max_length=210)]
    value: Name
    holds: bool = True


class Never(DataModel):
    """What must never be: all facts of `facts` at once, while all of `during` hold."""

    title: Title = ""
    facts: Annotated[tuple[Fact, ...], Field(max_length=10)]
    during: Annotated[tuple[Fact, ...], Field(max_length=10)] = ()


class Outline(BaseModel):
    """A station in few answers. Names are checked when it is written down, so that what is not finished can be kept."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    title: Title = ""
    devices: Annotated[tuple[Device, ...], Field(max_length=40)] = ()
    product: Product
    never: Annotated[tuple[Never, ...], Field(max_length=40)] = ()


class OutlineThing(DataModel):
    """A thing that facts are about: `robot`, `tool`, `clamp`, `person`, `product` or `step`, and what it can be."""

    id: str
    kind: Literal["robot", "tool", "clamp", "person", "product", "step"]
    title: str
    values: dict[str, str]  # titles by names; what it is at the beginning comes first, where it is anything then


class OutlineProblem(DataModel):
    """Something in an outline that cannot be written down; `place` is the way to it, as in `["devices", 0, "name"]`."""

    place: list[str | int]
    why: str
    why_message: Message | None


class OutlineView(DataModel):
    """The documents that an outline becomes, by their paths; none while it has problems. `errors` make these
    documents unusable as they are.
    """

    files: dict[str, str]
    things: list[OutlineThing]
    problems: list[OutlineProblem]
    errors: list[FindingDocument]


class TemplatesView(DataModel):
    """Outlines to begin with, by their names."""

    templates: dict[str, Outline]
