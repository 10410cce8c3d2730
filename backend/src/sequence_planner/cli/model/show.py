"""`show`: the ground automaton of a model and the names that its texts use, for people and as JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from sequence_planner.analysis.lifted import guard_in_words
from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Kind,
    Operation,
    VariableDeclaration,
)
from sequence_planner.automaton.lifting.wording import wording_of
from sequence_planner.cli.analysing import Deadline, Limits, analysed, guarded
from sequence_planner.cli.loading import LoadedModel, usable_automaton, usable_model
from sequence_planner.cli.model.pipelines import chosen, pipeline_lines
from sequence_planner.cli.model.synthesize import Guards, added_lines, described_automaton
from sequence_planner.cli.options import FINDINGS, USUAL_MEMORY, AnyModel, AsJson, Memory, print_json, refuse
from sequence_planner.controller.io.pipeline_graph import pipelines_view
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.printer import print_assignment, print_expression, print_value
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Expression,
    ExpressionError,
)
from sequence_planner.model.sequences import SequencePart

Lines = Iterator[str]
Reactions = Mapping[str, tuple[str, ...]]  # the effects of each ability, by their names
Added = Mapping[str, list[str]]  # the lines about what the supervisor adds to each ability
Said = Callable[[Expression], str]  # a condition as it is told

LONGEST = 30.0  # seconds that whoever wants to see a model waits for guards


def show(
    model: AnyModel,
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME]...", help="Show these only: a resource, variable, ability, operation, predicate, type, ..."
        ),
    ] = None,
    pipelines: Annotated[bool, typer.Option("--pipelines", help="Show the pipelines of topics and flows.")] = False,
    expanded: Annotated[bool, typer.Option("--expanded", help="Write out all that the model has a name for.")] = False,
    deadline: Deadline = LONGEST,
    memory: Memory = USUAL_MEMORY,
    json: AsJson = False,
) -> None:
    """Show what a model means: its variables, ground abilities with their effects, operations and specifications, and
    the names that it gives to what is said more than once.

    A NAME shows what bears it and what begins with it: `robot` is all of the robot, `robot.move` all its instances.
    The guard that the supervisor adds to a start stands apart from those that are written, with where it comes from.
    The exit code is 1 when these could not be found out in the time or memory there is.
    Conditions are told in the words of the model, unless they are to be --expanded: predicates, sets and relations by
    their names.
    With --json also the transitions of each phase of the tick, with what they read and write; conditions are written
    out there.
    With --pipelines instead the typed graph of each topic and flow, of which a NAME is also one: the fields on each
    edge, where a stage adds or changes some, and what becomes of them.
    """
    limits = Limits(deadline, memory)
    wanted = list(names or ())
    if pipelines:
        _show_pipelines(model, usable_model(model), wanted, json)
        return
    automaton = usable_automaton(model)
    declared = list(_declared(automaton))
    known = [*_names(automaton), *(each.name for each in declared)]
    if not wanted or not all(any(_bears(each, name) for each in known) for name in wanted):
        written = list(_written(model))
        declared += written
        known += [each.name for each in written]
    declared = [each for each in declared if _chosen(each.name, wanted)]
    for name in wanted:
        if not any(_bears(each, name) for each in known):
            refuse(f"{model}: there is nothing called `{name}`{suggestion(name, known)}")
    guards, unfinished = _guards(automaton, wanted, limits)
    if json:
        described = described_automaton(automaton, guards, lambda name: _chosen(name, wanted))
        sections = {
            section: {each.name: each.content for each in declared if each.section == section} for section in _SECTIONS
        }
        print_json({**described, **sections})
    else:
        told = guards if expanded else {name: guard_in_words(automaton, guard) for name, guard in guards.items()}
        said = print_expression if expanded else wording_of(automaton).in_words
        rest = "marked" if automaton.one_at_a_time else "rest"
        added = {name: added_lines(guard, rest) for name, guard in told.items()}
        typer.echo("\n".join(_lines(automaton, added, wanted, declared, said)).strip("\n"))
    if unfinished:
        raise typer.Exit(FINDINGS)


def _show_pipelines(path: Path, model: LoadedModel, wanted: list[str], json: bool) -> None:
    if model.station is None:
        refuse(f"{path}: a plain automaton has no pipelines")
    view = pipelines_view(model.station.pipelines)
    known = [*view.pipelines, *(each.resource for each in view.pipelines.values())]
    for name in wanted:
        if name not in known:
            refuse(f"{path}: no topic, flow or resource with one is called `{name}`{suggestion(name, known)}")
    view = chosen(view, wanted)
    if json:
        print_json(view.model_dump(mode="json"))
    else:
        typer.echo("\n".join(pipeline_lines(view)))


def _guards(automaton: Automaton, wanted: list[str], limits: Limits) -> tuple[Guards, bool]:
    """The guard that the supervisor adds to each ability that is to be shown, and whether time or memory were short."""
    shown = frozenset(name for name in automaton.abilities if _chosen(name, wanted))
    if not shown or (not automaton.specifications and automaton.rest is None):
        return {}, False
    found = guarded(automaton, shown, limits) if wanted else analysed(automaton, limits)
    if found.document.supervised is False:
        typer.echo("there is no supervisor: `check` says why", err=True)
    elif found.document.guards is None:
        typer.echo(f"the guards of the supervisor are not shown: {found.unfinished}", err=True)
    guards = {start: guard for guard in (found.document.guards or {}).values() for start in guard.starts}
    return guards, found.unfinished is not None


def _names(automaton: Automaton) -> list[str]:
    groups: tuple[Iterable[str], ...] = (
        automaton.resources,
        automaton.variables,
        automaton.abilities,
        automaton.operations,
        automaton.specifications,
        automaton.work_masters,
        automaton.alarms,
        (effect.name for effect in automaton.effects),
    )
    return [name for group in groups for name in group]


def _bears(name: str, wanted: str) -> bool:
    return name == wanted or any(name.startswith(f"{wanted}{sign}") for sign in (".", "(", "[", ":"))


def _chosen(name: str, wanted: list[str]) -> bool:
    return not wanted or any(_bears(name, each) for each in wanted)


def _lines(
    automaton: Automaton, added: Added, wanted: list[str], declared: Iterable[_DeclaredName], said: Said
) -> Lines:
    if not wanted:
        yield f"{automaton.title} ({automaton.name})"
    for resource, title in (*automaton.resources.items(), (None, "The station")):
        variables = [v for v in automaton.variables.values() if v.resource == resource and _chosen(v.name, wanted)]
        abilities, effects = _of_resource(automaton, resource)
        shown = [*_variables(variables), *_abilities(abilities, effects, automaton.reactions, added, wanted, said)]
        if shown:
            yield from ("", title if resource is None else f"{title} ({resource})", *shown)
    if automaton.one_at_a_time:
        yield from _transitions(automaton, added, wanted, said)
    for operation in automaton.operations.values():
        if _chosen(operation.name, wanted):
            yield from ("", *_operation(operation, said))
    for specification in automaton.specifications.values():
        if _chosen(specification.name, wanted):
            yield from ("", f"specification {specification.name}: {specification.title}")
            yield f"  forbidden   {said(specification.forbidden)}"
    for master in automaton.work_masters.values():
        if _chosen(master.name, wanted):
            yield from ("", f"work master {master.name}: {master.title}")
            for step, before in master.operations.items():
                yield f"  {step}" + (f" after {', '.join(sorted(before))}" if before else "")
            for what, groups in (("one of", master.alternatives), ("one at a time", master.arbitrary)):
                yield from (f"  {what}: {' | '.join(', '.join(sorted(each)) for each in group)}" for group in groups)
            yield from _actions("brings", master.brings, said)
    for alarm in automaton.alarms.values():
        if _chosen(alarm.name, wanted):
            title = alarm.title.get("en") or next(iter(alarm.title.values()))
            after = f", for {alarm.delay:g} s" if alarm.delay else ""
            yield from ("", f"alarm {alarm.name}: {title} ({alarm.priority})")
            yield f"  when        {said(alarm.when)}{after}"
    for each in declared:
        yield from ("", *each.lines)
    if not wanted and automaton.rest is not None:
        yield from ("", f"rest  {said(automaton.rest)}")


# Names for what is said more than once: they are in no automaton.

_SECTIONS = ("values", "relations", "maps", "predicates", "sequences", "types")


class _DeclaredName(NamedTuple):
    section: str
    name: str
    lines: tuple[str, ...]
    content: Mapping[str, object]


def _declared(automaton: Automaton) -> Iterator[_DeclaredName]:
    """The enumerations and sets, relations, maps and predicates."""
    vocabulary = automaton.vocabulary
    for name, values in vocabulary.domains.items():
        is_ordered = values in vocabulary.ordered
        line = f"values {name}: {', '.join(values.values)}{', in this order' if is_ordered else ''}"
        yield _DeclaredName("values", name, (line,), {"values": list(values.values), "ordered": is_ordered})
    for name, relation in vocabulary.relations.items():
        first, second = relation.types
        partners = {one: [other for other in second.values if (one, other) in relation.pairs] for one in first.values}
        lines = [f"  {one} with {', '.join(others)}" for one, others in partners.items() if others]
        yield _DeclaredName("relations", name, (f"relation {name}", *lines), dict(partners))
    for name, table in vocabulary.maps.items():
        images = {one: table.table[one] for one in table.source.values if one in table.table}
        lines = [f"  {one} to {print_value(value)}" for one, value in images.items()]
        yield _DeclaredName("maps", name, (f"map {name}", *lines), dict(images))
    for name, predicate in vocabulary.predicates.items():
        parameters = [f"{each}: {', '.join(values.values)}" for each, values in predicate.parameters.items()]
        when, means = print_expression(predicate.body), _meaning(automaton, name)
        shown = f"{name}({', '.join(predicate.parameters)})" if parameters else name
        lines = [*(f"  {'for':10}  {each}" for each in parameters), f"  {'when':10}  {when}"]
        lines += [] if means is None or means == when else [f"  {'that is':10}  {means}"]
        content: dict[str, object] = {
            "parameters": {each: list(values.values) for each, values in predicate.parameters.items()},
            "when": when,
            "means": means,
        }
        yield _DeclaredName("predicates", name, (f"predicate {shown}", *lines), content)


def _meaning(automaton: Automaton, name: str) -> str | None:
    """What a predicate stands for; None of one with parameters."""
    predicate = automaton.vocabulary.predicates[name]
    if predicate.parameters:
        return None
    try:
        return print_expression(automaton.read_condition(name))
    except ExpressionError:  # it reads the activity of an operation, which nothing else does
        return None


def _written(path: Path) -> Iterator[_DeclaredName]:
    """The sequences of a station, and its types with their instances, as they are written."""
    from sequence_planner.model.loader import load_station  # noqa: PLC0415 (few want them)
    from sequence_planner.model.types.layers import written_types  # noqa: PLC0415

    if not path.is_dir():
        return  # a plain automaton has neither
    for name, document in load_station(path).sequences.items():
        title = f": {document.main_title}" if document.title else ""
        content = document.model_dump(mode="json", by_alias=True, exclude_none=True, exclude_defaults=True)
        lines = tuple(_sequence(document, "  "))
        yield _DeclaredName("sequences", str(name), (f"sequence {name}{title}", *lines), content)
    for kind, (parameters, instances) in written_types(path).items():
        lines = tuple(f"  {each}: {what}" for each, what in parameters.items())
        of = (f"  instances   {', '.join(instances)}",) if instances else ()
        said = {"parameters": parameters, "instances": instances}
        yield _DeclaredName("types", kind, (f"type {kind}", *lines, *of), said)


def _sequence(part: SequencePart, margin: str) -> Lines:
    over = ", ".join(f"{each} in {values}" for each, values in part.each.items())
    yield f"{margin}{part.kind}{f' for {over}' if over else ''}"
    for branch in part.branches:
        yield from _sequence(branch, f"{margin}  ") if isinstance(branch, SequencePart) else (f"{margin}  {branch}",)


def _of_resource(automaton: Automaton, resource: str | None) -> tuple[list[Ability], list[Effect]]:
    """The abilities and effects of a resource; the transitions of a plain automaton are of none."""
    if automaton.one_at_a_time:
        return [], []
    abilities = [ability for ability in automaton.abilities.values() if ability.resource == resource]
    return abilities, [effect for effect in automaton.effects if effect.resource == resource]


def _variables(variables: Iterable[VariableDeclaration]) -> Lines:
    for kind in Kind:
        for variable in variables:
            if variable.kind is kind:
                initial = print_value(variable.initial)
                yield f"  {kind.value:9}  {variable.name}: {variable.type}, initially {initial}"


def _abilities(
    abilities: Iterable[Ability], effects: Iterable[Effect], of: Reactions, added: Added, wanted: list[str], said: Said
) -> Lines:
    """Abilities with their effects; one that several share stands below the first of them that is shown."""
    left = {effect.name: effect for effect in effects}
    for ability in abilities:
        is_chosen = _chosen(ability.name, wanted)
        own = [name for name in of.get(ability.name, ()) if name in left and (is_chosen or _chosen(name, wanted))]
        if is_chosen:
            yield from _ability(ability, added.get(ability.name, ()), said)
        for name in own:
            yield from _effect(left.pop(name), said)


def _ability(ability: Ability, added: Sequence[str], said: Said) -> Lines:
    restart = ", for restart mode only" if ability.restart else ""
    yield from ("", f"  ability {ability.name}: {ability.title}{restart}")
    yield from _condition("enabled", ability.enabled, TRUE, said)
    yield from _condition("start", ability.start_guard, TRUE, said)
    yield from _added(added)
    yield from _actions("start", ability.start_actions, said, "    ")
    yield from _condition("executing", ability.executing, FALSE, said)
    yield from _condition("finished", ability.finished, FALSE, said)
    if ability.finish_guard is not None:
        yield from _condition("finish", ability.finish_guard, None, said)
        yield from _actions("finish", ability.finish_actions, said, "    ")
    yield from _actions("cancel", ability.cancel_actions, said, "    ")
    if ability.human is not None:
        yield f"    person      {ability.human.text} (acknowledged by {ability.human.acknowledgement})"
    if not ability.moves:
        yield "    nothing moves by it"
    limits = {"react": ability.timeouts.react, "finish": ability.timeouts.finish}
    for name, seconds in limits.items():
        if seconds is not None:
            yield f"    {name} within {seconds:g} s"
    if ability.timeouts.replan:
        again = ability.timeouts.retries
        tried = f", tried again {'once' if again == 1 else f'{again} times'}" if again else ""
        yield f"    overdue     called off{tried}, then planned without it"
    if ability.duration is not None:
        yield f"    duration    {_seconds(*ability.duration)}"


def _effect(effect: Effect, said: Said) -> Lines:
    fault = ", a fault" if effect.fault else ""
    yield f"    effect {effect.name} ({effect.kind}{fault}, {_seconds(effect.shortest, effect.longest)})"
    yield f"      {'when':10}  {said(effect.guard)}"
    yield from _actions("do", effect.actions, said, "      ")


def _transitions(automaton: Automaton, added: Added, wanted: list[str], said: Said) -> Lines:
    """Those of a plain automaton."""
    for ability in automaton.abilities.values():
        if _chosen(ability.name, wanted):
            yield from ("", f"controllable {ability.name}")
            yield from _condition("guard", ability.start_guard, TRUE, said)
            yield from _added(added.get(ability.name, ()))
            yield from _actions("set", ability.start_actions, said, "    ")
    for effect in automaton.effects:
        if _chosen(effect.name, wanted):
            yield from ("", f"uncontrollable {effect.name}")
            yield from _condition("guard", effect.guard, TRUE, said)
            yield from _actions("set", effect.actions, said, "    ")


def _operation(operation: Operation, said: Said) -> Lines:
    once = "" if operation.repeat else ", once until it is reset"
    yield f"operation {operation.name}: {operation.title}, priority {operation.priority}{once}"
    yield f"  precondition  {said(operation.precondition)}"
    yield f"  goal          {said(operation.goal)}"
    if operation.local is not None:
        yield f"  local         {said(operation.local)}"


def _condition(name: str, condition: Expression, usual: Expression | None, said: Said) -> Lines:
    """A condition, if it says more than the usual one."""
    if condition != usual:
        yield f"    {name:10}  {said(condition)}"


def _added(lines: Sequence[str]) -> Lines:
    """What the supervisor adds."""
    for name, line in zip_longest(("supervisor",) if lines else (), lines, fillvalue=""):
        yield f"    {name:10}  {line}"


def _actions(name: str, actions: Iterable[Assignment], said: Said, margin: str = "  ") -> Lines:
    for action in actions:
        yield f"{margin}{name:10}  {print_assignment(action, said)}"


def _seconds(fewest: float, most: float) -> str:
    return f"{fewest:g} s" if fewest == most else f"{fewest:g} to {most:g} s"
