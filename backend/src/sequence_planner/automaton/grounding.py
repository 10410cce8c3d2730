"""Grounding of a station's model: resolved abilities, operations, work masters and specifications."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from graphlib import CycleError, TopologicalSorter
from itertools import combinations, pairwise
from pathlib import Path
from typing import NamedTuple

from sequence_planner.automaton.automaton import (
    Ability,
    AlarmDeclaration,
    Automaton,
    Effect,
    Flag,
    HumanTask,
    Instruction,
    Kind,
    Operation,
    Specification,
    Timeouts,
    VariableDeclaration,
    WorkMaster,
    commanded,
    target,
)
from sequence_planner.automaton.declarations import FLAGS, OPERATION, Declarations, GroundAbility, GroundBefore
from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.automaton.findings import (
    Binding,
    Findings,
    UseOfRemoved,
    followed_by,
    instance_name,
    own_title,
    readable,
    title_of,
    told_where_removed,
    with_values,
    without_arguments,
)
from sequence_planner.automaton.sequences.expansion import StationSequences, Steps
from sequence_planner.language.fitting import misfit
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import (
    NameScope,
    resolve_assignments,
    resolve_formula,
    resolve_predicate,
    suggestion,
)
from sequence_planner.language.simplifier import simplify, simplify_assignment
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    CircleError,
    Constant,
    Expression,
    ExpressionError,
    Name,
    Not,
    Or,
    UnusableError,
    Variable,
    conjunction,
    conjuncts,
    occurrences,
    variables,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, Place
from sequence_planner.model.documents import (
    AbilityDocument,
    EffectDocument,
    InstructionDocument,
    OperationDocument,
    SpecificationDocument,
    TimeoutsDocument,
)
from sequence_planner.model.fields import Predicate, by_language, words_of
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding, ModelError, SourceText

# What a text of a document means at its place: predicates, formulas and actions, resolved and checked.

_KINDS = {
    Kind.MEASURED: "a measured variable",
    Kind.OUTPUT: "an output variable",
    Kind.ESTIMATED: "an estimated variable",
}


def _not_a_variable(name: str) -> str:
    return "the activity of an operation" if name.startswith(f"{OPERATION}.") else "a flag of an ability"


def _written_twice(variable: VariableDeclaration, one: Assignment, other: Assignment) -> str:
    wrong = f"`{variable.name}` is written twice by one transition"
    if one.condition is None and other.condition is None:
        return f"{wrong}: keep one of the two"
    if isinstance(variable.type, BooleanType):
        return f"{wrong}: put the cases into one value, such as `(A and B) or (C and D)`"
    return f"{wrong}: give the ability a parameter for the case, and let its condition say which case it is"


class Writing(NamedTuple):
    """A writer, in words, and the kinds of variables that it may write."""

    what: str
    kinds: tuple[Kind, ...]


class Meaning:
    """Texts in the light of what is declared. What is wrong with one is noted, and it then means nothing (`false`)."""

    def __init__(self, declarations: Declarations, findings: Findings) -> None:
        self.declarations = declarations
        self.findings = findings
        self.circle: frozenset[str] = frozenset()  # of predicates that need each other, to which a text led
        self._activities: dict[str, None] = {}  # in order

    def scope(self, binding: Binding, *prefixes: str) -> NameScope:
        """Return what names mean for a part with these parameters, in these surroundings."""
        return NameScope(self.declarations.types, prefixes, binding, self.declarations.vocabulary)

    def predicate(self, text: Predicate, scope: NameScope) -> Expression:
        """A condition."""
        return self._condition(text, scope, lambda written: resolve_predicate(parse(written), scope))

    def formula(self, text: Predicate, scope: NameScope) -> Expression:
        """A formula of linear temporal logic over finite traces."""
        return self._condition(text, scope, lambda written: resolve_formula(parse_formula(written), scope))

    def actions(
        self, texts: Iterable[SourceText], scope: NameScope, guard: Expression, writing: Writing
    ) -> tuple[Assignment, ...]:
        """The actions of one transition, taken under `guard`."""
        actions: dict[str, Assignment] = {}
        for text, action in ((each, action) for each in texts for action in self._actions(each, scope)):
            name = target(action)
            variable = self.declarations.variables.get(name)
            if variable is None or variable.kind not in writing.kinds:
                kind = _KINDS[variable.kind] if variable else _not_a_variable(name)
                permitted = " or ".join(writing.kinds)
                written = text[action.target.span.start : action.target.span.end]
                self.findings.add(text, f"{writing.what} writes {permitted} variables, and `{written}` is {kind}")
            elif name in actions:
                self.findings.add(text, _written_twice(variable, actions[name], action))
            elif action.condition != FALSE:
                actions[name] = action
                self._check_fits(text, action, guard)
                if Kind.MEASURED in writing.kinds:
                    self.check_observable(text, action.value, action.condition or TRUE)
        return tuple(actions.values())

    def check_observable(self, text: SourceText, *read: Expression) -> None:
        """A device knows nothing of what we believe, and an emulated one only hears messages."""
        for seen in (each for expression in read for each in occurrences(expression)):
            if not self.is_observable(seen.name):
                written = text[seen.span.start : seen.span.end]
                message = f"an effect depends on measured and output variables only, and `{written}` is neither"
                self.findings.add_within(text, seen.span, message)

    def is_observable(self, name: str) -> bool:
        """Return whether a device, or what emulates one, can know of a variable."""
        variable = self.declarations.variables.get(name)
        return variable is not None and variable.kind is not Kind.ESTIMATED

    @property
    def activities(self) -> dict[str, VariableDeclaration]:
        """The activities of operations that some text reads."""
        return {name: VariableDeclaration(name, BOOLEAN, Kind.ACTIVITY, False, None) for name in self._activities}

    def take(self, findings: Iterable[Finding], activities: Iterable[str]) -> None:
        """Take over what was noted of a part that was read by itself."""
        self.findings.all.extend(findings)
        self._activities |= dict.fromkeys(activities)

    def _condition(self, text: Predicate, scope: NameScope, read: Callable[[SourceText], Expression]) -> Expression:
        if not isinstance(text, SourceText):
            return Constant(bool(text))
        try:
            return self._noted(text, simplify(read(text)))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return FALSE

    def _actions(self, text: SourceText, scope: NameScope) -> tuple[Assignment, ...]:
        try:
            actions = tuple(map(simplify_assignment, resolve_assignments(parse_assignment(text), scope)))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return ()
        for action in actions:
            self._noted(text, action.value)
            self._noted(text, action.condition or TRUE)
        return actions

    def _noted(self, text: SourceText, expression: Expression) -> Expression:
        """The meaning of `text`, whose readings of operations are kept in mind."""
        if OPERATION in text or self.declarations.vocabulary.predicates:
            read = (variable.name for variable in occurrences(expression))
            self._activities |= dict.fromkeys(name for name in read if name.startswith(f"{OPERATION}."))
        return expression

    def _check_fits(self, text: SourceText, action: Assignment, guard: Expression) -> None:
        if (found := misfit(action, guard)) is not None:
            advice = "add a condition to the guard, or with `if` to the action, under which it fits"
            self.findings.add_within(text, action.value.span, f"{found}: {advice}")

    def _misread(self, text: SourceText, error: ExpressionError, scope: NameScope) -> None:
        if isinstance(error, UnusableError):
            return  # what is wrong is told where the predicate is declared
        if isinstance(error, CircleError):
            self.circle = frozenset(error.circle)
        name = without_arguments(text[error.span.start : error.span.end])
        owner = name.rpartition(".")[0]  # of a flag
        known = [prefix + one for prefix in (*scope.prefixes, "") for one in (name, owner)]
        if any(each in self.declarations.broken for each in known):
            return
        removed = next((each for each in known if each in self.declarations.removed), None)
        if removed is None or removed in self.declarations.variables:
            self.findings.add_within(text, error.span, error.message)
        else:
            self._uses_removed(text.at(error.span), removed)

    def _uses_removed(self, place: Place, full: str) -> None:
        word, entry = full.rpartition(".")[2], self.declarations.removed[full]
        said = f"`{word}` is removed at {entry}: keep it there, or write something else here"
        in_type = bool(place.instance)
        self.findings.all.append(UseOfRemoved(place, said, word, entry) if in_type else Finding(place, said))


# Predicates, which are written out where they are used.


def check_predicates(meaning: Meaning) -> None:
    """Note what is wrong with a predicate, once and where it is declared, for all values of its parameters; a circle at
    the first predicate that is in it.
    """
    declarations = meaning.declarations
    told: set[frozenset[str]] = set()  # circles
    for full, prefixes, parameters, condition in declarations.written_predicates():
        apart = Meaning(declarations, Findings())
        for binding in declarations.bindings(parameters):
            apart.predicate(condition, apart.scope(binding, *prefixes))
            if found := apart.findings.all:
                if not apart.circle or (full in apart.circle and apart.circle not in told):
                    meaning.take(found, ())
                    told.add(apart.circle)
                declarations.broken.add(full)
                break


# Ground abilities with their effects.

_COMMANDS = (Kind.OUTPUT, Kind.ESTIMATED)
START = Writing("a start", _COMMANDS)
FINISH = Writing("a finish", _COMMANDS)
CANCEL = Writing("a cancel", _COMMANDS)
EFFECT = Writing("an effect", (Kind.MEASURED,))


def ground_abilities(
    meaning: Meaning, before: GroundBefore | None = None
) -> tuple[dict[str, Ability], tuple[Effect, ...], dict[str, tuple[str, ...]]]:
    """All abilities by name, what is expected of the devices, and by ability the names of its part of that.

    A reaction that is said once for each value of a parameter it does not depend on is one reaction. What was ground
    `before` and means the same is not ground again.
    """
    abilities: dict[str, Ability] = {}
    effects: dict[tuple[object, ...], Effect] = {}
    reactions: dict[str, tuple[str, ...]] = {}
    declarations, places = meaning.declarations, meaning.declarations.places
    before = before or GroundBefore()
    before.begin(declarations)
    for resource, name, document in declarations.written_abilities():
        make = partial(_ground, declarations, resource, name, document)
        for each in before.ground(resource, name, document, make):
            ability = each.ability
            abilities[ability.name] = ability
            places |= each.places
            meaning.take(each.findings, each.activities)
            for key, effect, place in each.effects:
                shared = effects.setdefault(key, effect)
                if shared is effect:
                    places[effect.name] = place
                reactions[ability.name] = (*reactions.get(ability.name, ()), shared.name)
    before.end()
    return abilities, tuple(effects.values()), reactions


def _ground(
    declarations: Declarations, resource: str, name: SourceText, document: AbilityDocument
) -> list[GroundAbility]:
    return [
        _instance(declarations, resource, name, document, binding)
        for binding in declarations.bindings(document.parameters)
    ]


def _instance(
    declarations: Declarations, resource: str, name: SourceText, document: AbilityDocument, binding: Binding
) -> GroundAbility:
    findings = Findings()
    meaning = Meaning(declarations, findings)
    scope = meaning.scope(binding, f"{instance_name(f'{resource}.{name}', binding)}.", f"{resource}.")
    ability = _ability(meaning, resource, name, document, binding, scope)
    effects: list[tuple[tuple[object, ...], Effect, Place]] = []
    for effect_name, effect_document in document.effects.items():
        full = f"{ability.name}.{effect_name}"
        effect = _effect(meaning, full, resource, effect_name, effect_document, scope, ability.executing)
        written = (resource, str(name), str(effect_name))
        effects.append(((written, effect.guard, effect.actions), effect, effect_name.place))
    places = _places(ability.name, name, document)
    return GroundAbility(ability, places, tuple(effects), tuple(findings.all), tuple(meaning.activities))


def _ability(
    meaning: Meaning, resource: str, name: SourceText, document: AbilityDocument, binding: Binding, scope: NameScope
) -> Ability:
    enabled = meaning.predicate(document.enabled, scope)
    start_guard = meaning.predicate(document.start.when, scope)
    start_actions = meaning.actions(document.start.do, scope, conjunction(enabled, start_guard), START)
    executing, finish_guard = _course(meaning, resource, document, scope, start_actions)
    finish = document.finish
    cancelled = () if document.cancel is None else document.cancel.do
    return Ability(
        name=instance_name(f"{resource}.{name}", binding),
        resource=resource,
        title=title_of(document.title, name, binding, meaning.declarations.titles),
        enabled=enabled,
        start_guard=start_guard,
        start_actions=start_actions,
        executing=executing,
        finished=meaning.predicate(document.finished, scope),
        finish_guard=finish_guard,
        finish_actions=()
        if finish is None or finish_guard is None
        else meaning.actions(finish.do, scope, finish_guard, FINISH),
        restart=document.restart,
        human=_human(meaning, resource, document, binding),
        timeouts=_timeouts(document.timeouts),
        duration=document.duration,
        cancel_actions=meaning.actions(cancelled, scope, TRUE, CANCEL),
        instruction=_instruction(meaning, document.instruction, binding),
    )


def _course(
    meaning: Meaning, resource: str, document: AbilityDocument, scope: NameScope, start: Sequence[Assignment]
) -> tuple[Expression, Expression | None]:
    """While what it executes, and when it finishes: as written, or what follows from its command and `until`."""
    finish = None if document.finish is None else meaning.predicate(document.finish.when, scope)
    if document.until is None:
        return meaning.predicate(document.executing, scope), finish
    until = meaning.predicate(document.until, scope)
    variables = meaning.declarations.variables.values()
    command = commanded(start, {v.name for v in variables if v.kind is Kind.OUTPUT and v.resource == resource})
    if command == TRUE and isinstance(document.until, SourceText) and not meaning.findings.all:
        message = f"`until` needs a command: a start action that writes an output of `{resource}`"
        meaning.findings.add(document.until, message)
    if "executing" in document.model_fields_set:
        executing = meaning.predicate(document.executing, scope)
    else:
        executing = simplify(conjunction(*conjuncts(command), Not(until)))
    parts = (command, until, TRUE if finish is None else finish)
    return executing, simplify(conjunction(*(each for part in parts for each in conjuncts(part))))


def _timeouts(document: TimeoutsDocument) -> Timeouts:
    return Timeouts(document.react, document.finish, document.retries, document.then == "replan")


def _human(meaning: Meaning, resource: str, document: AbilityDocument, binding: Binding) -> HumanTask | None:
    if document.human is None:
        return None
    text = document.human.acknowledgement
    check_acknowledgement(meaning, resource, text)
    return HumanTask(title_of(document.human.task, "", binding, meaning.declarations.titles), f"{resource}.{text}")


def _instruction(meaning: Meaning, document: InstructionDocument | None, binding: Binding) -> Instruction | None:
    if document is None:
        return None
    titles = meaning.declarations.titles
    return Instruction(
        {
            language: readable(said, "", binding, titles, language or "en")
            for language, said in by_language(document.text).items()
        },
        document.image and with_values(document.image, binding),
        document.video and with_values(document.video, binding),
    )


def check_acknowledgement(meaning: Meaning, resource: str, text: SourceText) -> None:
    """Note an acknowledgement that is no measured `bool` of the resource."""
    variables = meaning.declarations.variables
    variable = variables.get(f"{resource}.{text}")
    if variable is None or variable.kind is not Kind.MEASURED or variable.type != BOOLEAN:
        candidates = [v for v in variables.values() if v.resource == resource and v.type == BOOLEAN]
        own = [v.name.removeprefix(f"{resource}.") for v in candidates if v.kind is Kind.MEASURED]
        meaning.findings.add(text, f"`{text}` must be a measured bool of `{resource}`{suggestion(text, own)}")


def _effect(
    meaning: Meaning,
    name: str,
    resource: str,
    written: SourceText,
    document: EffectDocument,
    scope: NameScope,
    executing: Expression,
) -> Effect:
    if document.when is None:
        guard = executing
        unseen = (each for each in variables(guard) if not meaning.is_observable(each))
        if (found := next(unseen, None)) is not None:
            what = f"`{found}` is neither a measured nor an output variable"
            meaning.findings.add(written, f"without `when` it happens while the ability executes, and {what}")
    else:
        guard = observable_condition(meaning, document.when, scope)
    actions = meaning.actions(document.do, scope, guard, EFFECT)
    shortest, longest = document.takes
    return Effect(name, resource, document.kind, guard, actions, shortest, longest, document.fault)


def observable_condition(meaning: Meaning, text: Predicate, scope: NameScope) -> Expression:
    """The condition of an effect."""
    guard = meaning.predicate(text, scope)
    if isinstance(text, SourceText):
        meaning.check_observable(text, guard)
    return guard


def _places(ability: str, name: SourceText, document: AbilityDocument) -> dict[str, Place]:
    """Return where the ability and its parts were written; a part that is left out stands where the ability does."""
    written = {flag: getattr(document, flag) for flag in FLAGS}
    finish = True if document.finish is None else document.finish.when
    if document.until is not None:
        finish = finish if isinstance(finish, SourceText) else document.until
        written["executing"] = document.executing or document.until
    parts = {**written, "start": document.start.when, "finish": finish}
    return {
        ability: name.place,
        **{f"{ability}.{part}": _ability_place(text, name.place) for part, text in parts.items()},
    }


def _ability_place(text: object, otherwise: Place) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise


# Ground operations, and the work masters that put them into jobs.

BROUGHT = Writing("a new product", (Kind.ESTIMATED,))


def ground_operations(meaning: Meaning, station: Station) -> dict[str, Operation]:
    """All operations by name, in the order of the sequences."""
    operations = {operation.name: operation for operation in _operations(meaning, station.operations)}
    for name in station.sequences:
        meaning.declarations.check_name(name, "sequence")
    ordered = station_sequences(meaning, station, operations).ordered(operations)
    read = (
        each
        for operation in ordered.values()
        for turn in operation.turns.values()
        for each in variables(turn.condition)
    )
    meaning.take((), (each for each in read if each.startswith(f"{OPERATION}.")))
    return ordered


def station_sequences(meaning: Meaning, station: Station, operations: Collection[str]) -> StationSequences:
    """The sequences over these ground operations; what is wrong is noted."""
    return StationSequences(meaning.declarations, meaning.findings, station, operations)


def ground_work_masters(
    meaning: Meaning, station: Station, operations: Mapping[str, Operation]
) -> dict[str, WorkMaster]:
    """All work masters by name."""
    masters: dict[str, WorkMaster] = {}
    sequences = station_sequences(meaning, station, operations)
    ordered = {
        name: [each for turn in operation.turns.values() for each in turn.after]
        for name, operation in operations.items()
    }
    for name, document in station.work_masters.items():
        meaning.declarations.check_name(name, "work_master")
        if document.brings:
            meaning.declarations.places[f"work_master.{name}.brings"] = document.brings[0].place
        order = sequences.order_of(document)
        check_steps(meaning, order.steps, operations, ordered, name)
        masters[str(name)] = WorkMaster(
            str(name),
            title_of(document.title, name, {}),
            {str(step): frozenset(map(str, before)) for step, before in order.steps.items()},
            brought_by(meaning, document.brings),
            order.alternatives,
            order.arbitrary,
        )
    return masters


def _operations(meaning: Meaning, documents: Mapping[SourceText, OperationDocument]) -> Iterator[Operation]:
    for name, document in documents.items():
        for binding in meaning.declarations.bindings(document.parameters):
            full = instance_name(name, binding)
            scope = meaning.scope(binding)
            places = meaning.declarations.places
            places[f"{OPERATION}.{full}"] = name.place
            if document.local is not None:
                places[f"{OPERATION}.{full}.local"] = _operation_place(document.local, name)
            yield Operation(
                full,
                title_of(document.title, name, binding, meaning.declarations.titles),
                meaning.predicate(document.precondition, scope),
                meaning.predicate(document.goal, scope),
                document.priority,
                None if document.local is None else meaning.formula(document.local, scope),
                document.repeat,
            )


def _operation_place(text: Predicate, otherwise: SourceText) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise.place


def check_steps(
    meaning: Meaning,
    steps: Steps,
    operations: Collection[str],
    ordered: Mapping[str, Sequence[str]] | None = None,
    master: SourceText | None = None,
) -> None:
    """Note steps that are none of the `operations`, and those that come before themselves, by way of what sequences
    have `ordered` too. That is told where the work master writes one of them, or else at its name `master`.
    """
    findings, ordered = meaning.findings, ordered or {}
    for step, before in steps.items():
        if step not in operations:
            findings.add(step, f"there is no operation `{step}`{suggestion(step, operations)}")
        for each in before:
            if each not in steps:
                findings.add(each, f"`{each}` is no operation of this job{suggestion(each, map(str, steps))}")
    graph = {str(step): [*map(str, before), *ordered.get(step, ())] for step, before in steps.items()}
    others = {name: before for name, before in ordered.items() if name not in graph}
    try:
        TopologicalSorter({**graph, **others}).prepare()
    except CycleError as error:
        circle: list[str] = error.args[1]
        texts = [each for step, before in steps.items() if step in circle for each in (step, *before) if each in circle]
        own = [each for each in texts if master is None or each.place.file == master.place.file]
        message = f"each of these would have to come before the next: {' → '.join(circle)}"
        findings.add(own[0] if own else master or texts[0], f"{message}. Leave out one of the orders that say so")


def brought_by(meaning: Meaning, texts: Iterable[SourceText]) -> tuple[Assignment, ...]:
    """Return what a new product brings: it is known beforehand, so the values are constants."""
    brought: dict[str, Assignment] = {}
    for text in texts:
        for action in meaning.actions([text], meaning.scope({}), TRUE, BROUGHT):
            if not isinstance(action.value, Constant) or action.condition is not None:
                meaning.findings.add(text, "a new product brings certain values: write `variable := value`")
            if target(action) in brought:
                meaning.findings.add(text, f"`{target(action)}` is brought twice")
            brought[target(action)] = action
    return tuple(brought.values())


# Specifications as forbidden states. The shorthands engineers use are defined by what they expand to here.
#
#     forbidden: A                    A
#     never: A, while: B              A and B
#     exclusive: [a, b, ...]          a.executing and b.executing, for each two
#     zone: {r: A, s: B, ...}         A and B, for each two
#     order: [A, B, ...]              B and not A, for each two neighbours
#
# An ability with parameters stands for all its ground abilities in `exclusive`: one of them executes.

Part = tuple[str, Expression]  # what of a specification is forbidden, and in which words


def ground_specifications(
    meaning: Meaning, documents: Mapping[SourceText, SpecificationDocument], resources: Iterable[str]
) -> dict[str, Specification]:
    """All specifications by name; `resources` are those that can share a zone."""
    specifications: dict[str, Specification] = {}
    known = list(resources)
    for name, document in documents.items():
        meaning.declarations.check_name(name, "specification")
        meaning.declarations.check_parameters(document.parameters, *(f"{name}." for name in document.zone or ()))
        for binding in meaning.declarations.bindings(document.parameters):
            full = instance_name(name, binding)
            title = title_of(document.title, name, binding, meaning.declarations.titles, apart=False)
            for words, forbidden in _parts(meaning, document, binding, known):
                part = f"{full}: {words}" if words else full
                specifications[part] = Specification(part, followed_by(title, words), simplify(forbidden))
                meaning.declarations.places[part] = name.place
    return specifications


def _parts(meaning: Meaning, document: SpecificationDocument, binding: Binding, resources: list[str]) -> Iterator[Part]:
    scope = meaning.scope(binding)
    if document.forbidden is not None:
        yield "", meaning.predicate(document.forbidden, scope)
    elif document.never is not None and document.during is not None:
        yield "", conjunction(meaning.predicate(document.never, scope), meaning.predicate(document.during, scope))
    elif document.exclusive is not None:
        yield from _at_most_one(exclusive_abilities(meaning, document.exclusive, scope))
    elif document.zone is not None:
        yield from _at_most_one([_inside(meaning, *entry, binding, resources) for entry in document.zone.items()])
    elif document.order is not None:
        stages = [(_words(text), meaning.predicate(text, scope)) for text in document.order]
        for (first, before), (then, after) in pairwise(stages):
            yield f"{first} before {then}", conjunction(after, Not(before))


def exclusive_abilities(meaning: Meaning, texts: Sequence[SourceText], scope: NameScope) -> list[Part]:
    """That each of the named abilities executes; none of them is named twice."""
    executing = [(str(text), _executing(meaning, text, scope)) for text in texts]
    for (one, (_, flags)), (other, (_, others)) in combinations(zip(texts, executing, strict=True), 2):
        if shared := sorted(set(variables(flags)) & set(variables(others))):
            ability = shared[0].removesuffix(".executing")
            meaning.findings.add(other, f"`{ability}` is in `{one}` as well: no ability excludes itself")
    return executing


def _at_most_one(parts: Iterable[Part]) -> Iterator[Part]:
    for (one, first), (other, second) in combinations(parts, 2):
        yield f"{one} and {other}", conjunction(first, second)


def _words(text: Predicate) -> str:
    return " ".join(str(text).split())


def _inside(meaning: Meaning, resource: SourceText, text: Predicate, binding: Binding, resources: list[str]) -> Part:
    """The condition, in its own words, under which a resource is in a zone."""
    if resource not in resources:
        meaning.findings.add(resource, f"there is no resource `{resource}`{suggestion(resource, resources)}")
        return str(resource), FALSE
    return str(resource), meaning.predicate(text, meaning.scope(binding, f"{resource}."))


def _executing(meaning: Meaning, text: SourceText, scope: NameScope) -> Expression:
    """That the named ability executes, or one of those that bear its name with parameters."""
    try:
        named = parse(text)
        if not isinstance(named, Name):
            raise ExpressionError("expected the name of an ability, such as `robot.move`", named.span)
        name = str(scope.substitute(named))
        flags = [flag for flag in scope.variables if flag.endswith(".executing")]
        found = [flag for flag in flags if flag == f"{name}.executing"]
        found = found or [flag for flag in flags if without_arguments(flag) == f"{name}.executing"]
        if not found:
            abilities = {each for flag in flags for each in (flag, without_arguments(flag))}
            near = suggestion(name, sorted(each.removesuffix(".executing") for each in abilities))
            if (entry := meaning.declarations.removed.get(name)) is not None:
                near = f": it is removed at {entry}"
            raise ExpressionError(f"there is no ability `{name}`{near}", named.span)
    except ExpressionError as error:
        if without_arguments(str(text)) not in meaning.declarations.broken:
            meaning.findings.add_within(text, error.span, error.message)
        return FALSE
    flags_read = tuple(Variable(flag, BOOLEAN) for flag in found)
    return flags_read[0] if len(flags_read) == 1 else Or(flags_read)


# Alarms, which read the state and are read by nothing.


def ground_alarms(meaning: Meaning, station: Station) -> dict[str, AlarmDeclaration]:
    """All alarms by name, with the resource before those of one."""
    found = {}
    for resource, documents in ((None, station.station.alarms), *((n, d.alarms) for n, d in station.resources.items())):
        for name, document in documents.items():
            meaning.declarations.check_name(name, "alarm")
            full = str(name) if resource is None else f"{resource}.{name}"
            scope = meaning.scope({}, *(() if resource is None else (f"{resource}.",)))
            found[full] = AlarmDeclaration(
                full,
                resource,
                alarm_condition(meaning, document.when, scope),
                document.priority,
                words_of(document.title) or {"": readable(None, name, {}).capitalize()},
                words_of(document.consequence),
                words_of(document.action),
                document.delay,
                document.when.place if isinstance(document.when, SourceText) else name.place,
            )
    return found


def alarm_condition(meaning: Meaning, text: Predicate, scope: NameScope) -> Expression:
    """The condition of an alarm. What it read of an operation would become a variable, and no alarm makes any."""
    apart = Meaning(meaning.declarations, meaning.findings)
    when = apart.predicate(text, scope.not_suggesting(f"{OPERATION}."))
    if isinstance(text, SourceText):
        for seen in occurrences(when):
            if seen.name in apart.activities:
                message = "an alarm reads variables and the flags of abilities: write what the operation waits for"
                meaning.findings.add_within(text, seen.span, message)
    return when


# The automaton of a station, put together from its parts.


def ground(station: Station, before: GroundBefore | None = None) -> Automaton:
    """The automaton that `station` means; what was ground `before` and means the same is not ground again.

    Raises `ModelError` with all findings.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    meaning = Meaning(declarations, findings)
    check_predicates(meaning)
    abilities, effects, reactions = ground_abilities(meaning, before)
    operations = ground_operations(meaning, station)
    specifications = ground_specifications(meaning, station.specifications, station.resources)
    work_masters = ground_work_masters(meaning, station, operations)
    alarms = ground_alarms(meaning, station)
    rest = meaning.predicate(station.station.rest, meaning.scope({}))
    if isinstance(station.station.rest, SourceText):
        declarations.places.setdefault("rest", station.station.rest.place)
    declarations.places |= {Path(place.file).name: place for place in station.empty}
    automaton = Automaton(
        name=str(station.station.name),
        title=own_title(station.station.title, station.station.name),
        description=str(station.station.description or ""),
        resources={name: own_title(doc.title, name) for name, doc in station.resources.items()},
        variables=declarations.variables | meaning.activities,
        abilities=abilities,
        flags=_flags(abilities, declarations, findings),
        effects=effects,
        operations=operations,
        specifications=specifications,
        rest=rest,
        work_masters=work_masters,
        alarms=alarms,
        places=declarations.places,
        reactions=reactions,
        vocabulary=declarations.vocabulary,
        indices=declarations.indices(),
        titles=declarations.titles,
    )
    if findings.all:
        raise ModelError(told_where_removed(findings.all))
    return automaton


def _flags(abilities: dict[str, Ability], declarations: Declarations, findings: Findings) -> tuple[Flag, ...]:
    flags = [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
    ordered, circle = ordered_flags(flags)
    if circle:
        ability = abilities[circle[0].rpartition(".")[0]]
        message = f"flags depend on each other in a circle: {' → '.join(circle)}"
        findings.add(declarations.places[ability.name], message)
    return ordered


def ground_variables(station: Station) -> tuple[Automaton, list[Finding]]:
    """An automaton that has the variables of `station` alone, those that are declared as they should be; and what is
    wrong with the names that are declared.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    automaton = Automaton(
        name=str(station.station.name),
        title=own_title(station.station.title, station.station.name),
        description="",
        resources={name: own_title(doc.title, name) for name, doc in station.resources.items()},
        variables=declarations.variables,
        abilities={},
        flags=(),
        places=declarations.places,
        vocabulary=declarations.vocabulary,
        titles=declarations.titles,
    )
    return automaton, findings.all
