"""The automaton: variables, abilities, effects, operations and specifications, all ground and resolved."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Iterable, Mapping
from enum import StrEnum
from functools import cached_property

from sequence_planner.core.immutable import Immutable, uncompared
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.shorthand.titles import NO_TITLES, Titles, Words
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY, Vocabulary
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Comparison,
    Expression,
    Not,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.language.types import BOOLEAN, Place, Type, Value

# A state gives every variable and every ability flag a value; None is unknown. Never changed once made.
State = Mapping[str, Value | None]


class Kind(StrEnum):
    """Writer of a variable."""

    MEASURED = "measured"
    OUTPUT = "output"
    ESTIMATED = "estimated"
    ACTIVITY = "activity"  # the tick: whether an operation is active; only of operations that some expression reads


class VariableDeclaration(Immutable):
    """A variable by its full name; `resource` is None for those of the station.

    With `dual_approval` a correction or force of it needs a second person.
    """

    name: str
    type: Type
    kind: Kind
    initial: Value
    resource: str | None
    dual_approval: bool = False


class Effect(Immutable):
    """An expected reaction of measured variables, taking between `shortest` and `longest` seconds."""

    name: str
    resource: str
    kind: str
    guard: Expression
    actions: tuple[Assignment, ...]
    shortest: float = 0.0
    longest: float = 0.0
    fault: bool = False


class HumanTask(Immutable):
    """A task that a person is asked to do, and the measured variable that says it is done."""

    text: str
    acknowledgement: str


class Instruction(Immutable):
    """How a person does something: a sentence by language, and the paths of a picture and a video in the station's
    folder.
    """

    text: Words
    image: str | None = None
    video: str | None = None


class Timeouts(Immutable):
    """Seconds after a start by which an ability must have reacted, and have finished, before an alarm is raised.

    It has reacted when it has been seen executing, or has finished. With `replan` its cancel actions are taken besides,
    and a plan is made anew: with it as long as it has been overdue no more than `retries` times, then without it.
    """

    react: float | None = None
    finish: float | None = None
    retries: int = 0
    replan: bool = False


class LateTexts(Immutable):
    """What it means that an ability has not begun, or not finished, in time: by language, with the full names of
    variables in braces where their values stand.
    """

    not_begun: Mapping[str, str] = {}
    not_finished: Mapping[str, str] = {}


class Ability(Immutable):
    """A ground ability. `finish_guard` is None when it is done at its start.

    `cancel_actions` are taken when a running ability is called off; `duration` is the shortest and longest time in
    seconds that a run is estimated to take. People are not told that something `moves` where nothing does.
    """

    name: str
    resource: str
    title: str
    enabled: Expression
    start_guard: Expression
    start_actions: tuple[Assignment, ...]
    executing: Expression
    finished: Expression
    finish_guard: Expression | None
    finish_actions: tuple[Assignment, ...]
    restart: bool = False
    human: HumanTask | None = None
    timeouts: Timeouts = Timeouts()
    duration: tuple[float, float] | None = None
    cancel_actions: tuple[Assignment, ...] = ()
    instruction: Instruction | None = uncompared(default=None)
    moves: bool = uncompared(default=True)
    late: LateTexts = uncompared(default=LateTexts())

    def flag(self, which: str) -> str:
        """The full name of its flag `enabled`, `executing` or `finished`."""
        return f"{self.name}.{which}"


class Flag(Immutable):
    """A truth value that equals its predicate after every synchronisation."""

    name: str
    predicate: Expression


class Turn(Immutable):
    """When it is an operation's turn in a sequence: right behind the operations `after`, and while none `beside` it
    keeps it waiting.
    """

    condition: Expression
    after: tuple[str, ...]
    beside: tuple[str, ...]


class GroupKind(StrEnum):
    """How operations belong together in a sequence that does not put them one behind the other."""

    PARALLEL = "parallel"
    ALTERNATIVE = "alternative"
    ARBITRARY = "arbitrary"


class OperationGroup(Immutable):
    """Operations that a sequence, or with `for_jobs` a work master, of this name puts beside one another. It bears on
    nothing: what follows from it stands in preconditions and in jobs.
    """

    kind: GroupKind
    operations: tuple[str, ...]
    name: str
    for_jobs: bool


class Operation(Immutable):
    """A ground operation; of several that cannot be planned together, the highest `priority` is kept.

    `local` is a formula of LTL over finite traces (`language.ltl`) for the run from its activation to its goal.
    Without `repeat`, once completed, it does not activate again until it has been reset. `turns` are the parts of its
    precondition that sequences add, by their names, to what is `written` in its place.
    """

    name: str
    title: str
    precondition: Expression
    goal: Expression
    priority: int = 0
    local: Expression | None = None
    repeat: bool = True
    turns: Mapping[str, Turn] = uncompared(default={})
    written: Expression | None = uncompared(default=None)

    @property
    def activity(self) -> str:
        """The full name of the truth value that says whether it is active."""
        return f"operation.{self.name}.active"


class Specification(Immutable):
    """A ground specification: no state may satisfy `forbidden`."""

    name: str
    title: str
    forbidden: Expression


Branches = tuple[frozenset[str], ...]
"""The operations of each branch, in the order in which they are written."""


class WorkMaster(Immutable):
    """The operations that a job consists of, each with those that must be completed before it.

    `brings` are the estimated values that a new product has. Of the branches of an alternative one is taken, of those
    in arbitrary order one at a time.
    """

    name: str
    title: str
    operations: Mapping[str, frozenset[str]]
    brings: tuple[Assignment, ...] = ()
    alternatives: tuple[Branches, ...] = ()
    arbitrary: tuple[Branches, ...] = ()


class AlarmDeclaration(Immutable):
    """An alarm of the model, raised when `when` has held for `delay` seconds. Its texts are by language; one that is
    written in no language in particular is under the empty one.
    """

    name: str
    resource: str | None
    when: Expression
    priority: str
    title: Mapping[str, str]
    consequence: Mapping[str, str]
    action: Mapping[str, str]
    delay: float
    place: Place


class Automaton(Immutable):
    """All of it. `flags` are in an order in which none depends on a later one.

    A station's automaton goes by the tick. With `one_at_a_time` it is a plain automaton: it has neither flags nor
    finishes, its abilities are its controllable transitions and its effects the others, and a step is one of them.
    `initial` describes the initial states of one that has several; each declared initial value then is that of one of
    them. `goals` are formulas over its runs. `alarms` bear on nothing that it does. `places` says where a part was
    written, by its name; `groups` which operations sequences put beside one another; `reactions` which effects are
    written with an ability; `vocabulary` what its texts say, and `indices` the parameters of what was written once for
    several, each with what it ranges over, by its name: `bolts`, `robot.move`, `operation.tighten`,
    `specification.never`; `titles` what it calls its parts when it speaks to people.
    """

    name: str
    title: str
    description: str
    resources: Mapping[str, str]  # name: title
    variables: Mapping[str, VariableDeclaration]
    abilities: Mapping[str, Ability]
    flags: tuple[Flag, ...]
    effects: tuple[Effect, ...] = ()
    operations: Mapping[str, Operation] = {}
    specifications: Mapping[str, Specification] = {}
    rest: Expression | None = None  # None: every state is one of rest
    work_masters: Mapping[str, WorkMaster] = {}
    one_at_a_time: bool = False
    initial: Expression | None = None
    goals: tuple[Expression, ...] = ()
    alarms: Mapping[str, AlarmDeclaration] = uncompared(default={})
    places: Mapping[str, Place] = uncompared(default={})
    groups: tuple[OperationGroup, ...] = uncompared(default=())
    reactions: Mapping[str, tuple[str, ...]] = uncompared(default={})
    vocabulary: Vocabulary = uncompared(default=NO_VOCABULARY)
    indices: Mapping[str, Mapping[str, str]] = uncompared(default={})
    titles: Titles = uncompared(default=NO_TITLES)

    def names(self, kind: Kind) -> tuple[str, ...]:
        """The variables of a kind, in order of declaration."""
        return tuple(name for name, variable in self.variables.items() if variable.kind is kind)

    @cached_property
    def outputs(self) -> frozenset[str]:
        """The output variables."""
        return frozenset(self.names(Kind.OUTPUT))

    @cached_property
    def job_operations(self) -> frozenset[str]:
        """The operations of work masters."""
        return frozenset(name for master in self.work_masters.values() for name in master.operations)

    @cached_property
    def branching_operations(self) -> frozenset[str]:
        """The operations of work masters that stand in alternatives, or in arbitrary order."""
        masters = self.work_masters.values()
        return frozenset().union(
            *(b for m in masters for branches in (*m.alternatives, *m.arbitrary) for b in branches)
        )

    @cached_property
    def types(self) -> Mapping[str, Type]:
        """The type of each variable and flag."""
        types: dict[str, Type] = {name: variable.type for name, variable in self.variables.items()}
        return types | dict.fromkeys((flag.name for flag in self.flags), BOOLEAN)

    @cached_property
    def scope(self) -> NameScope:
        """The meaning of names in a text about the whole station."""
        return NameScope(self.types, vocabulary=self.vocabulary)

    def read_condition(self, text: str) -> Expression:
        """A condition that somebody writes about the whole station. Raises `ExpressionError`."""
        return resolve_predicate(parse(text), self.scope)

    def read_action(self, text: str) -> Assignment:
        """An action that somebody writes about the whole station. Raises `ExpressionError`."""
        return resolve_assignment(parse_assignment(text), self.scope)

    @cached_property
    def flag_predicates(self) -> Mapping[str, Expression]:
        """The predicate of each flag."""
        return {flag.name: flag.predicate for flag in self.flags}

    @cached_property
    def flag_readers(self) -> Mapping[str, tuple[int, ...]]:
        """By variable or flag, the numbers of the flags whose predicates read it, ascending."""
        readers: dict[str, list[int]] = defaultdict(list)
        for number, flag in enumerate(self.flags):
            for name in dict.fromkeys(variables(flag.predicate)):
                readers[name].append(number)
        return {name: tuple(numbers) for name, numbers in readers.items()}

    @cached_property
    def finish_readers(self) -> Mapping[str, tuple[str, ...]]:
        """By variable or flag, the abilities whose finish guard or finish actions read it."""
        readers: dict[str, dict[str, None]] = defaultdict(dict)
        for ability in self.abilities.values():
            guard = () if ability.finish_guard is None else variables(ability.finish_guard)
            for name in (*guard, *(name for action in ability.finish_actions for name in reads(action))):
                readers[name][ability.name] = None
        return {name: tuple(names) for name, names in readers.items()}

    @cached_property
    def initial_valuation(self) -> State:
        """The declared initial value of each variable; flags are undetermined."""
        values: dict[str, Value | None] = {name: variable.initial for name, variable in self.variables.items()}
        return values | dict.fromkeys((flag.name for flag in self.flags), None)


def target(action: Assignment) -> str:
    """The full name of the variable an action writes."""
    assert isinstance(action.target, Variable)
    return action.target.name


def commanded(actions: Iterable[Assignment], outputs: Container[str]) -> Expression:
    """The condition that those of `outputs` which `actions` always write have the values that are written."""
    told = (each for each in actions if each.condition is None and target(each) in outputs)
    return conjunction(*(_has_value(each.target, each.value) for each in told))


def _has_value(variable: Expression, value: Expression) -> Expression:
    if value in (TRUE, FALSE):
        return variable if value == TRUE else Not(variable)
    return Comparison("==", variable, value)


def reads(action: Assignment) -> frozenset[str]:
    """The variables an action reads."""
    condition = () if action.condition is None else variables(action.condition)
    return frozenset((*variables(action.value), *condition))
