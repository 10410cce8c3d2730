"""Document schemas of a station's model: resources, abilities, topics, services, operations, flows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, model_validator

from sequence_planner.model.fields import Action, DocumentPart, Given, Predicate, Seconds, TypeName, Words
from sequence_planner.model.sequences import SequencePart, TitledDocument
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.marks import ReadValue
from sequence_planner.model.stages.registry import StageDocument
from sequence_planner.texts.message import message

# What the services and actions of a resource may hold: the station is their client, the device their server.

Period = Annotated[float, Field(gt=0, le=86_400)]


class ServiceDocument(DocumentPart):
    """A ROS 2 service of the device. It is called when an output rises, or every so often, or both."""

    type: SourceText
    """The service type, `package/srv/Name`."""
    when: Given[SourceText] = None
    """An output of type `bool`: the service is called when it becomes true."""
    every: Given[Period] = None
    """Seconds from one call to the next."""
    deadline: Period = 1.0
    """Seconds without an answer after which what the answer says is unknown."""
    ignore: list[SourceText] = Field(default_factory=list)
    """Fields of the request and of the response that are no variables."""
    request: list[StageDocument] = Field(default_factory=list)
    """Stages from variables to the request, as of an outgoing topic."""
    response: list[StageDocument] = Field(default_factory=list)
    """Stages from the response to variables, as of an incoming topic."""

    @model_validator(mode="after")
    def _is_called(self) -> ServiceDocument:
        if self.when is None and self.every is None:
            raise ValueError(message("form.when-or-every"))
        return self


class ActionDocument(DocumentPart):
    """A ROS 2 action of the device. A goal is sent when an output rises, and cancelled when it falls."""

    type: SourceText
    """The action type, `package/action/Name`."""
    when: SourceText
    """An output of type `bool`: a goal is sent when it becomes true, and cancelled when it becomes false."""
    status: SourceText
    """The measured variable that says what has become of the goal."""
    deadline: Period = 1.0
    """Seconds without an answer of the server after which the goal is lost."""
    ignore: list[SourceText] = Field(default_factory=list)
    """Fields of the goal, of the feedback and of the result that are no variables."""
    goal: list[StageDocument] = Field(default_factory=list)
    """Stages from variables to the goal, as of an outgoing topic."""
    feedback: list[StageDocument] = Field(default_factory=list)
    """Stages from the feedback to variables, as of an incoming topic."""
    result: list[StageDocument] = Field(default_factory=list)
    """Stages from the result to variables, as of an incoming topic."""


# What flows and the examples of pipelines may hold.

Moment = Annotated[float, Field(ge=0, le=86_400)]


class ExampleStepDocument(DocumentPart):
    """One moment of an example: what comes, and what is expected then."""

    at: Moment
    """Seconds from the beginning of the example."""
    given: Given[Mapping[SourceText, Any]] = None
    """The input; without it only time passes."""
    gives: Given[Mapping[SourceText, Any]] = None
    """The expected output; `null` is unknown. Fields not mentioned may have any value."""


class ExampleDocument(DocumentPart):
    """An example of what a pipeline does: `given` and `gives`, or `steps` with time."""

    name: SourceText
    """The behaviour it shows."""
    given: Given[Mapping[SourceText, Any]] = None
    """The fields of a message (incoming), the records by alias (a merge), or the variables (outgoing)."""
    gives: Given[Mapping[SourceText, Any]] = None
    """The variables (incoming) or fields of the message (outgoing) that come of it; `null` is unknown."""
    steps: Given[Annotated[list[ExampleStepDocument], Field(min_length=1)]] = None
    """Its steps in order of time."""

    @model_validator(mode="after")
    def _one_form(self) -> ExampleDocument:
        if (self.steps is None) == (self.given is None or self.gives is None):
            raise ValueError(message("form.example"))
        if self.steps is not None:
            if self.given is not None or self.gives is not None:
                raise ValueError(message("form.example-steps"))
            moments = [step.at for step in self.steps]
            if moments != sorted(moments):
                raise ValueError(message("form.example-order"))
        return self


class FlowDocument(DocumentPart):
    """Records of topics or other flows: of one, of several as they arrive, or of several as one."""

    source: SourceText | list[SourceText] | dict[SourceText, SourceText] = Field(alias="from")
    """A topic or flow; a list of them; or `{alias: topic or flow}`, whose fields are then `alias.field`."""
    pipeline: list[StageDocument] = Field(default_factory=list)
    """Stages."""
    examples: list[ExampleDocument] = Field(default_factory=list)
    """Examples with expected outputs, checked by `check`."""

    @model_validator(mode="after")
    def _has_sources(self) -> FlowDocument:
        if not isinstance(self.source, str) and not self.source:
            raise ValueError(message("form.from"))
        return self


# What each document of a station may hold. Texts keep their place (`SourceText`), so that errors can name it.


Parameters = dict[SourceText, TypeName]


def _interval(value: object) -> object:
    if isinstance(value, list) and len(value) == 2:
        return tuple(value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        return (value, value)
    raise ValueError(message("form.seconds"))


def _ascending(interval: tuple[float, float]) -> tuple[float, float]:
    if interval[0] > interval[1]:
        raise ValueError(message("form.interval", least=f"{interval[0]:g}", most=f"{interval[1]:g}"))
    return interval


Duration = Annotated[
    tuple[Seconds, Seconds],
    BeforeValidator(_interval, json_schema_input_type=Seconds | tuple[Seconds, Seconds]),
    AfterValidator(_ascending),
]


# The words for values: `{placed: placed, tightened: tight}`, or `{true: in place, false: away}`.
ValueTitles = dict[ReadValue, Words]


class VariableDocument(DocumentPart):
    """A variable: `type` is `bool`, an enumeration, or a range such as `0..3`.

    A measured or output variable without one has the type of the message field that it belongs to.
    """

    type: Given[TypeName] = None
    """`bool`, an enumeration, or a range such as `0..3`. May be left out where a message field tells it."""
    initial: Given[bool | int | SourceText] = None
    """The first value; without it the first of the type."""
    each: Parameters = Field(default_factory=dict, alias="for")
    """One variable per value of an enumeration: `{where: side}` makes `name[left]` and `name[right]`."""
    approval: Literal["single", "dual"] = "single"
    """`dual`: each correction and force of it needs a second person (four-eyes principle)."""
    title: Given[Words] = None
    """For people: what it tells of, such as `Robot` or, with `for`, `{pair}`."""
    phrase: Given[Words] = None
    """How people are told its value, such as `the robot is at {value}`; without it `TITLE is {value}`."""
    titles: ValueTitles = Field(default_factory=dict)
    """Words for its values, in the place of those of its enumeration: `{true: in place, false: away}`."""
    by_hand: ValueTitles = Field(default_factory=dict)
    """What a person does at the station so that a measured variable gets a value: `{open: Turn the handle up.}`."""


class StartDocument(DocumentPart):
    """The start of an ability: a further guard beside `enabled`, and the actions."""

    when: Predicate = True
    """Condition for a start beside `enabled`."""
    do: list[Action] = Field(default_factory=list)
    """Actions on outputs and estimates, such as `wanted := closed`."""


class FinishDocument(DocumentPart):
    """The finish of an ability: its guard and actions."""

    when: Predicate = True
    """As soon as this holds, and what the ability goes on `until`, the finish actions are taken."""
    do: list[Action] = Field(default_factory=list)
    """Actions on outputs and estimates."""


class EffectDocument(DocumentPart):
    """Expected reaction of measured variables; `takes` is its shortest and longest time in seconds."""

    kind: Literal["starting", "executing", "finishing"] = "executing"
    """For the reader: when in a run it is expected."""
    each: Parameters = Field(default_factory=dict, alias="for")
    """One effect per value of an enumeration: `{where: side}` makes `name[left]` and `name[right]`."""
    when: Given[Predicate] = None
    """The condition under which it happens, on measured and output variables; without it while the ability executes."""
    do: list[Action] = Field(min_length=1)
    """Actions on measured variables, all taken at once."""
    takes: Duration = (0.5, 0.5)
    """Seconds, or the fewest and the most; emulated devices take so long."""
    fault: bool = False
    """It may happen, but nobody counts on it."""


class HumanDocument(DocumentPart):
    """A person carries the ability out: what the watch says, and the measured variable that is the acknowledgement."""

    task: Words
    """Text shown on the watch."""
    acknowledgement: SourceText
    """A measured `bool` of the resource."""


class InstructionDocument(DocumentPart):
    """How a person does it: a sentence, and a picture or a video in the folder `instructions` of the station."""

    text: Given[Words] = None
    """A sentence; `{parameter}` is replaced by what its value is called."""
    image: Given[SourceText] = None
    """A picture, `instructions/<name>.svg` (or png, jpg, webp); `{parameter}` is replaced by the value."""
    video: Given[SourceText] = None
    """A video, `instructions/<name>.mp4` (or webm); `{parameter}` is replaced by the value."""

    @model_validator(mode="after")
    def _tells_something(self) -> InstructionDocument:
        if not self.model_fields_set:
            raise ValueError(message("form.instruction"))
        return self


class CancelDocument(DocumentPart):
    """Actions taken when a running ability is called off."""

    do: list[Action] = Field(min_length=1)
    """Actions on outputs and estimates."""


class TimeoutsDocument(DocumentPart):
    """Seconds after the start: by when it must have reacted, and have finished; and what is done when it has not."""

    react: Given[Seconds] = None
    """By when it must have been seen executing, or have finished."""
    finish: Given[Seconds] = None
    """By when it must have finished."""
    then: Literal["alarm", "replan"] = "alarm"
    """The reaction beside the alarm: none, or the ability is called off and a plan is made again."""
    retries: Annotated[int, Field(ge=0, le=100)] = 0
    """Number of retries by such a plan before it is taken out of service and done without."""

    @model_validator(mode="after")
    def _says_when(self) -> TimeoutsDocument:
        if self.then == "replan" and self.react is None and self.finish is None:
            raise ValueError(message("form.replan"))
        if self.retries and self.then != "replan":
            raise ValueError(message("form.retries"))
        return self


class LateDocument(DocumentPart):
    """What is wrong when an ability is late, as a person would say it: what its alarm says first."""

    not_begun: Given[Words] = None
    """When it has not reacted by `timeouts.react`; `{parameter}` and `{variable}` are replaced by what their values are
    called."""
    not_finished: Given[Words] = None
    """When it has not finished by `timeouts.finish`; `{parameter}` and `{variable}` likewise."""


class AbilityDocument(DocumentPart):
    """An ability of a resource. `duration` estimates in seconds how long a run takes."""

    title: Given[Words] = None
    """For people; `{parameter}` is replaced by the value."""
    parameters: Parameters = Field(default_factory=dict)
    """`{name: enumeration}`: one ability per value."""
    restart: bool = False
    """Only for getting back to work after trouble."""
    moves: bool = True
    """Whether anything moves by it; without, people are not told that it is what moves next."""
    human: Given[HumanDocument] = None
    """A person does it."""
    instruction: Given[InstructionDocument] = None
    """How it is done, for the person who does it."""
    timeouts: TimeoutsDocument = TimeoutsDocument()
    """By when it must have reacted and finished, and what is done when it has not."""
    late: LateDocument = LateDocument()
    """What is wrong when it has not, in words for people."""
    duration: Given[Duration] = None
    """Seconds that a run is estimated to take, or the fewest and the most."""
    enabled: Predicate = True
    """The ability can be used now."""
    start: StartDocument = StartDocument()
    """The start: a further guard, and its actions."""
    until: Given[Predicate] = None
    """It goes on from its command until this holds: it executes while the outputs of its resource are as the start has
    set them and this does not hold, and finishes when both do."""
    executing: Predicate = False
    """It is under way; where that is something else than what `until` says."""
    finished: Predicate = False
    """It is done; for use in other conditions."""
    finish: Given[FinishDocument] = None
    """The finish. An ability without one is done with its start."""
    cancel: Given[CancelDocument] = None
    """Calling off a running ability."""
    effects: dict[SourceText, EffectDocument] = Field(default_factory=dict)
    """The device's expected reaction."""

    @model_validator(mode="after")
    def _has_an_end(self) -> AbilityDocument:
        if self.finish is None and self.until is None and self.timeouts != TimeoutsDocument():
            raise ValueError(message("form.timeouts"))
        if self.until is None and self.finish is not None and "when" not in self.finish.model_fields_set:
            raise ValueError(message("form.finish"))
        return self

    @model_validator(mode="after")
    def _can_be_late(self) -> AbilityDocument:
        for text, limit in (("not_begun", "react"), ("not_finished", "finish")):
            if getattr(self.late, text) is not None and getattr(self.timeouts, limit) is None:
                raise ValueError(message("form.never-late", text=text, limit=limit))
        return self

    @model_validator(mode="after")
    def _effects_happen(self) -> AbilityDocument:
        never = [name for name, each in self.effects.items() if each.when is None]
        if never and self.until is None and "executing" not in self.model_fields_set:
            raise ValueError(message("form.effect", name=str(never[0])))
        return self


class QualityDocument(DocumentPart):
    """The quality of service of a topic, in full."""

    reliability: Literal["reliable", "best_effort"] = "reliable"
    """`reliable` has lost messages sent again; `best_effort` does not."""
    durability: Literal["volatile", "transient_local"] = "volatile"
    """With `transient_local`, late joiners get the last messages."""
    depth: Annotated[int, Field(ge=1, le=10_000)] = 10
    """Number of messages kept."""
    deadline: Given[Annotated[float, Field(ge=0.001, le=86_400)]] = None
    """Seconds within which the next message comes."""
    liveliness: Given[Annotated[float, Field(ge=0.001, le=86_400)]] = None
    """Seconds within which a publisher shows that it is there."""


class TopicDocument(DocumentPart):
    """A ROS 2 topic. An incoming one is stale after `deadline` seconds; an outgoing one is repeated `every` seconds."""

    type: SourceText
    """The message type, `package/msg/Name`."""
    direction: Literal["in", "out"]
    """`in`: from a device; `out`: to a device."""
    deadline: Given[Annotated[float, Field(gt=0, le=86_400)]] = None
    """Seconds without a message after which the topic's variables are unknown; incoming topics only."""
    every: Given[Annotated[float, Field(gt=0, le=86_400)]] = None
    """Seconds after which the message is repeated; outgoing topics only."""
    quality: Literal["reliable", "sensor_data", "latched"] | QualityDocument = "reliable"
    """The topic's quality of service, by name or in full."""
    ros: Literal[1, 2] = 2
    """Version of ROS that the device speaks: 2, or 1, which is reached through a rosbridge server."""
    ignore: list[SourceText] = Field(default_factory=list)
    """Fields that are no variables."""
    pipeline: list[StageDocument] = Field(default_factory=list)
    """Stages, where names alone do not tell what belongs together."""
    examples: list[ExampleDocument] = Field(default_factory=list)
    """Examples with expected outputs, checked by `check`."""

    @model_validator(mode="after")
    def _timing_fits_direction(self) -> TopicDocument:
        if self.direction == "in" and self.every is not None:
            raise ValueError(message("form.every"))
        if self.direction == "out" and self.deadline is not None:
            raise ValueError(message("form.deadline"))
        return self


class AlarmDocument(DocumentPart):
    """An alarm that people are told while a condition holds. It changes nothing of what the station does."""

    when: Predicate
    """It is raised when this holds, and cleared when this does not; while that is unknown it stays as it is."""
    title: Given[Words] = None
    """What is wrong; a text, or one for each language: `{en: …, sv: …}`."""
    priority: Literal["high", "medium", "low"] = "medium"
    """`high`: act now. `medium`: a person is needed soon. `low`: a notice that nobody has to acknowledge."""
    consequence: Given[Words] = None
    """What comes of it if nobody does anything."""
    action: Given[Words] = None
    """What to do."""
    delay: Seconds = 0.0
    """Seconds for which the condition must have held before it is raised."""


# Names for sets of values, relations, maps and conditions, which texts use in place of what they stand for.


class EnumerationDocument(DocumentPart):
    """An enumeration that includes others, or whose values have an order: its own values, then those it includes."""

    values: list[SourceText] = Field(default_factory=list)
    """Its own values, in order."""
    includes: list[SourceText] = Field(default_factory=list)
    """Enumerations whose values it has as well."""
    ordered: bool = False
    """Whether `<`, `previous`, `next`, `first` and `last` go by the order of its values."""
    titles: ValueTitles = Field(default_factory=dict)
    """Words for its values, as they stand within a sentence: `{tightened: tight}`."""

    @model_validator(mode="after")
    def _has_values(self) -> EnumerationDocument:
        if not self.values and not self.includes:
            raise ValueError(message("form.enumeration"))
        return self


class SetDocument(DocumentPart):
    """A named set of values of an enumeration."""

    of: TypeName
    """The enumeration, or another set."""
    values: Given[Annotated[list[ReadValue], Field(min_length=1)]] = None
    """Its values; a set among them stands for all of its own."""
    excludes: Given[Annotated[list[ReadValue], Field(min_length=1)]] = Field(default=None, alias="except")
    """The values that are not in it, where all others are; a set among them stands for all of its own."""
    title: Given[Words] = None
    """For people: what is said in the place of `one of its values`, such as `a tool dock`."""

    @model_validator(mode="after")
    def _one_form(self) -> SetDocument:
        if (self.values is None) == (self.excludes is None):
            raise ValueError(message("form.set"))
        return self


Members = ReadValue | Annotated[list[ReadValue], Field(min_length=1)]


def _pair(written: object) -> object:
    if not isinstance(written, list) or len(written) != 2:
        raise ValueError(message("form.pair"))
    return written


def _two_domains(written: object) -> object:
    if not isinstance(written, list) or len(written) != 2:
        raise ValueError(message("form.relation"))
    return written


class RelationDocument(DocumentPart):
    """A relation between the values of two enumerations, by its pairs."""

    between: Annotated[list[TypeName], Field(min_length=2, max_length=2), BeforeValidator(_two_domains)]
    """The two enumerations or sets."""
    symmetric: bool = False
    """Whether each pair holds the other way round as well."""
    pairs: Annotated[
        list[Annotated[list[Members], Field(min_length=2, max_length=2), BeforeValidator(_pair)]], Field(min_length=1)
    ]
    """The pairs. A set, or a list, stands for each of its values: `[free, free]` is all pairs of these."""


class ValueMapDocument(DocumentPart):
    """A value for each value of an enumeration."""

    source: TypeName = Field(alias="from")
    """The enumeration or set that it is from."""
    to: TypeName
    """What it is to: an enumeration, `bool` or a range such as `0..3`."""
    values: dict[ReadValue, bool | int | SourceText] = Field(default_factory=dict)
    """The value for each; a set among the keys stands for all of its values."""
    otherwise: Given[bool | int | SourceText] = None
    """The value for all others; without it each needs its own."""


class PredicateDocument(DocumentPart):
    """A condition with a name, and parameters if it needs some."""

    title: Given[Words] = None
    """For people: a sentence that says it, such as `the robot holds {tool}`."""
    parameters: Parameters = Field(default_factory=dict)
    """`{name: enumeration}`: what it is about."""
    when: Predicate
    """The condition that it stands for."""


def _form_of_predicate(content: object) -> str:
    return "predicate" if isinstance(content, dict | PredicateDocument) else "condition"


NamedCondition = Annotated[
    Annotated[Predicate, Tag("condition")] | Annotated[PredicateDocument, Tag("predicate")],
    Discriminator(_form_of_predicate),
]


def _form_of_enumeration(content: object) -> str | None:
    if isinstance(content, dict | EnumerationDocument):
        return "enumeration"
    return "list" if isinstance(content, list) else None


EnumerationForm = Annotated[
    Annotated[list[SourceText], Field(min_length=1), Tag("list")] | Annotated[EnumerationDocument, Tag("enumeration")],
    Discriminator(_form_of_enumeration, "enumeration", "its values in a list, or `values` and what it `includes`"),
]


class ResourceDocument(DocumentPart):
    """A resource: its topics, its variables by who writes them, and what it can do."""

    title: Given[Words] = None
    """For people."""
    topics: dict[SourceText, TopicDocument] = Field(default_factory=dict)
    """The ROS 2 topics that the resource is reached by."""
    flows: dict[SourceText, FlowDocument] = Field(default_factory=dict)
    """Records of several topics brought together, or of one topic a second time."""
    services: dict[SourceText, ServiceDocument] = Field(default_factory=dict)
    """The ROS 2 services of the device that the station calls."""
    actions: dict[SourceText, ActionDocument] = Field(default_factory=dict)
    """The ROS 2 actions of the device that the station sends goals to."""
    measured: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    """Variables written by incoming messages."""
    output: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    """Variables written by abilities, which leave in outgoing messages."""
    estimated: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    """Variables written by abilities, which no message carries."""
    abilities: dict[SourceText, AbilityDocument] = Field(default_factory=dict)
    """Abilities of the resource."""
    alarms: dict[SourceText, AlarmDocument] = Field(default_factory=dict)
    """What people are told of the resource when something is wrong with it."""
    sets: dict[SourceText, SetDocument] = Field(default_factory=dict)
    """Values of an enumeration that have a name together, by names of the resource."""
    relations: dict[SourceText, RelationDocument] = Field(default_factory=dict)
    """Pairs of values that belong together, by names of the resource."""
    maps: dict[SourceText, ValueMapDocument] = Field(default_factory=dict)
    """Tables of values for values, by names of the resource."""
    predicates: dict[SourceText, NamedCondition] = Field(default_factory=dict)
    """Conditions with a name, which other conditions use by it."""


class PackageSourceDocument(DocumentPart):
    """Where a package is brought from: a folder, or a revision of a git repository."""

    path: Given[SourceText] = None
    """A folder, from that of the station."""
    git: Given[SourceText] = None
    """The address of a repository: `https://`, `ssh://` or `file://`."""
    revision: Given[SourceText] = None
    """A tag, a branch or a commit of it."""

    @model_validator(mode="after")
    def _is_somewhere(self) -> PackageSourceDocument:
        if (self.path is None) == (self.git is None) or (self.git is None) != (self.revision is None):
            raise ValueError(message("form.package"))
        return self


class StationDocument(DocumentPart):
    """The station as a whole: what is common to its resources. `rest` describes the states of rest."""

    name: SourceText
    """The station's name."""
    title: Given[Words] = None
    """For people."""
    description: Given[SourceText] = None
    """For people."""
    enumerations: dict[SourceText, EnumerationForm] = Field(default_factory=dict)
    """Named values, in order."""
    sets: dict[SourceText, SetDocument] = Field(default_factory=dict)
    """Values of an enumeration that have a name together."""
    relations: dict[SourceText, RelationDocument] = Field(default_factory=dict)
    """Which values of two enumerations belong together: `near(pose, position)`."""
    maps: dict[SourceText, ValueMapDocument] = Field(default_factory=dict)
    """A value for each value of an enumeration: `tool_for[position]`."""
    predicates: dict[SourceText, NamedCondition] = Field(default_factory=dict)
    """Conditions with a name, which other conditions use by it."""
    estimated: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    """Variables of the station as a whole, which abilities of every resource may write."""
    alarms: dict[SourceText, AlarmDocument] = Field(default_factory=dict)
    """What people are told of the station as a whole when something is wrong."""
    rest: Predicate = True
    """The states to which the station can always be brought back."""
    packages: dict[SourceText, PackageSourceDocument] = Field(default_factory=dict)
    """Packages of types of resources, and where each is brought from."""
    takeover: Literal["confirm", "automatic"] = "confirm"
    """After a hot standby has taken command: with `true`, a person confirms that production goes on."""
    deployment_approval: Literal["single", "dual"] = "single"
    """With `dual`, a revision takes the place of this model only once a second person has approved it."""

    def enumeration_values(self) -> dict[SourceText, tuple[SourceText, ...]]:
        """The values of each enumeration, in order: its own, then those that it includes and does not have yet.

        What includes itself, and names that are none, add nothing.
        """
        return {name: self._values(name, ()) for name in self.enumerations}

    def _values(self, name: SourceText, around: tuple[str, ...]) -> tuple[SourceText, ...]:
        written = self.enumerations.get(name)
        if not isinstance(written, EnumerationDocument):
            return tuple(written or ())
        within = (*around, str(name))
        included = (value for each in written.includes if each not in within for value in self._values(each, within))
        found: dict[str, SourceText] = {}
        for value in (*written.values, *included):
            found.setdefault(str(value), value)
        return tuple(found.values())


class OperationDocument(DocumentPart):
    """A production operation: active from its precondition to its goal. The highest `priority` is kept longest.

    `local` is a formula of linear temporal logic over the run from activation to goal.
    """

    title: Given[Words] = None
    """For people; `{parameter}` is replaced by the value."""
    parameters: Parameters = Field(default_factory=dict)
    """`{name: enumeration}`: one operation per value."""
    precondition: Predicate
    """It becomes active when this holds, and the goal does not."""
    goal: Predicate
    """It is completed when this holds."""
    local: Given[Predicate] = None
    """A formula that holds from its activation to its goal, such as `not bad U good`."""
    priority: int = 0
    """Rank: if not all active operations can be planned together, the lowest are left out first."""
    repeat: bool = True
    """If true, it can become active again once completed; otherwise only after a reset."""


class SpecificationDocument(DocumentPart):
    """What must never be. One of: states that are `forbidden`; `never` one thing `while` another; abilities that are
    `exclusive`; a `zone` that resources share; an `order` of conditions.
    """

    title: Given[Words] = None
    """For people; `{parameter}` is replaced by the value."""
    parameters: Parameters = Field(default_factory=dict)
    """`{name: enumeration}`: one specification per value."""
    forbidden: Given[Predicate] = None
    """States that must never be."""
    never: Given[Predicate] = None
    """Condition that must not hold `while` another one does."""
    during: Given[Predicate] = Field(default=None, alias="while")
    """While what `never` must not be."""
    exclusive: Given[list[SourceText]] = Field(default=None, min_length=2)
    """Abilities of which no two execute at once."""
    zone: Given[dict[SourceText, Predicate]] = Field(default=None, min_length=2)
    """Resources that share a space, each with the condition under which it is inside."""
    order: Given[list[Predicate]] = Field(default=None, min_length=2)
    """Conditions none of which holds without the one before."""

    @model_validator(mode="after")
    def _one_kind(self) -> SpecificationDocument:
        if (self.never is None) != (self.during is None):
            raise ValueError(message("form.never-while"))
        kinds = (self.forbidden, self.never, self.exclusive, self.zone, self.order)
        if sum(kind is not None for kind in kinds) != 1:
            raise ValueError(message("form.specification"))
        return self


class WorkStepDocument(DocumentPart):
    """An operation of a job: which others must be completed before it."""

    after: list[SourceText] = Field(default_factory=list)
    """The operations that must be completed before it."""


class WorkMasterDocument(SequencePart, TitledDocument):
    """What a job consists of: its operations with their order, and the estimated values a new product `brings`.

    The order is that of a sequence, of further `orders`, of `operations` with what comes before each, or of all of them
    together.
    """

    brings: list[SourceText] = Field(default_factory=list)
    """The estimated values of a new product, such as `part := absent`."""
    operations: Given[dict[SourceText, WorkStepDocument | None]] = Field(default=None, min_length=1)
    """The operations of a job, each with what comes before it."""
    orders: Given[list[SequencePart]] = Field(default=None, min_length=1)
    """Further orders that hold as well: an operation may stand in several."""

    @model_validator(mode="after")
    def _has_operations(self) -> WorkMasterDocument:
        if self.kind is None and self.operations is None and self.orders is None:
            raise ValueError(message("form.work-master"))
        return self

    @property
    def _needs_kind(self) -> bool:
        return False
