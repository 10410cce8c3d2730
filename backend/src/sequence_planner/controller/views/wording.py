"""Wording of recovery offers, refusals and values for operators, and predicates parsed from requests."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from sequence_planner.automaton.automaton import Ability, Automaton, State, target
from sequence_planner.automaton.dependencies import is_along, tasks_for
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.commands.command import CommandRefused, TextPlace
from sequence_planner.controller.views.proposals import (
    EffortView,
    OfferView,
    PlanPreviewView,
    PreviewStepView,
    ValueChangeView,
)
from sequence_planner.controller.views.station import DiagnosisView, SpecificationView
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.syntax import TRUE, Constant, Expression, ExpressionError
from sequence_planner.planning.diagnosis import (
    Diagnosis,
    Member,
    MemberKind,
    WrittenNames,
    correction_text,
    member_text,
)
from sequence_planner.planning.problem import Plan
from sequence_planner.planning.recovery.proposals import (
    OfferKind,
    RecoveryProposal,
    ValueChange,
)
from sequence_planner.planning.recovery.timing import estimated_times
from sequence_planner.texts.message import Argument, Item, Message, Sentence, as_it_was, message

# Offers in the words of the people they are shown to.


def offer_view(
    automaton: Automaton, offer: RecoveryProposal, id_: str, revision: int, obstacle: Message | None
) -> OfferView:
    """An offer as it is shown."""
    return OfferView(
        id=id_,
        revision=revision,
        kind=str(offer.kind),
        title=(title := offer_title(automaton, offer)),
        title_message=title,
        physical=_changes(automaton, told(automaton, offer.physical)),
        online=list(offer.online),
        in_service=list(offer.in_service),
        assumed=_changes(automaton, offer.assumed),
        corrections=_changes(automaton, offer.corrections, _tasks(automaton, offer)),
        errand=None if offer.operator_plan is None else plan_preview(automaton, offer.operator_plan, offer.start),
        ends=None if offer.operator_plan is None else end_text(offer.goal, offer.into_safe),
        ends_message=None if offer.operator_plan is None else end_message(automaton, offer.goal, offer.into_safe),
        into_safe=offer.into_safe,
        operation=offer.operation,
        needs_restart=needs_restart(offer),
        unsupervised=offer.unsupervised,
        at_rest=offer.at_rest,
        breaks=[SpecificationView(name=name, title=automaton.specifications[name].title) for name in offer.breaks],
        then=None if offer.then is None else plan_preview(automaton, offer.then, offer.end),
        goals=list(offer.goals),
        left_out=list(offer.left_out),
        claims=list(offer.claims),
        records=_changes(automaton, offer.records),
        only_if_checked=offer.only_if_checked,
        effort=EffortView(
            cost=offer.effort.cost,
            corrections=offer.effort.changes,
            physical=offer.effort.physical,
            returns=offer.effort.returns,
            starts=offer.effort.starts,
            seconds=offer.effort.seconds,
            time=offer.effort.time,
        ),
        obstacle=obstacle,
        obstacle_message=obstacle,
    )


def end_text(goal: Expression, into_safe: bool) -> str | None:
    """By what it is known that an operator plan has come to its end, beside that it is inside the safe states."""
    return None if into_safe and goal == TRUE else print_expression(goal)


def end_sentence(automaton: Automaton, goal: Expression, into_safe: bool) -> Sentence | None:
    """The same for people."""
    return None if into_safe and goal == TRUE else _said(automaton, goal)


def end_message(automaton: Automaton, goal: Expression, into_safe: bool) -> Message | None:
    """The same as a message."""
    said = end_sentence(automaton, goal, into_safe)
    return None if said is None else message("waits.condition", condition=said)


def _said(automaton: Automaton, condition: Expression) -> Sentence:
    return sentences_of(automaton).tell_so([condition], print_expression(condition))


def needs_restart(offer: RecoveryProposal) -> bool:
    """Return whether it can be taken in restart mode only: goals and resets by ordinary abilities go without."""
    ordinary = offer.kind in (OfferKind.GOAL, OfferKind.RESET)
    return (
        offer.restart
        or offer.unsupervised
        or bool(offer.corrections)
        or (offer.operator_plan is not None and not ordinary)
    )


def offer_title(automaton: Automaton, offer: RecoveryProposal) -> Message:
    """Say what is to be done, in one line."""
    first, *then = [*_parts(automaton, offer)] or [message("offer.nothing")]
    if offer.only_if_checked and not offer.by_hand:
        text = message("offer.checked", what=first)
    else:
        text = Message(f"{first.id}-first", first.arguments)
    for each in then:
        text = message("offer.then", first=text, then=each)
    return text


def title_text(title: str) -> Message:
    """Return what a person has taken, whose title may be of a record."""
    return as_it_was(title, "offer.")


def ended_text(why: str) -> Message:
    """Return how what a person has taken ended, which may be of a record."""
    return as_it_was(why, "ended.", "late.", "mode.")


def reason_text(reason: str) -> Message:
    """Return why a plan is as it is, where that may be a string."""
    return as_it_was(reason, "plan.", "ended.", "late.", "mode.", "offer.")


def _parts(automaton: Automaton, offer: RecoveryProposal) -> Iterator[Message]:
    returning = [automaton.resources[name] for name in offer.online]
    returning += [automaton.abilities[name].title for name in offer.in_service]
    if returning:
        yield message("offer.return", titles=returning)
    if offer.physical:
        yield from _by_people(automaton, offer)
    if offer.by_hand:
        yield message("offer.task", tasks=[ability.title for ability in _tasks(automaton, offer).values()])
    elif offer.only_if_checked:
        yield message("list", items=_so(automaton, offer.corrections))
    elif offer.corrections:
        yield message("offer.correct", changes=_each(automaton, offer.corrections, "offer.to"))
    if offer.operation is not None:
        yield message("offer.reset", operation=automaton.operations[offer.operation].title)
    elif offer.kind is OfferKind.GOAL:
        yield message("offer.goal", goal=_said(automaton, offer.goal))
    elif offer.operator_plan is not None and offer.operator_plan.starts:
        yield message("offer.start", titles=[automaton.abilities[name].title for _, name in offer.operator_plan.starts])
    elif offer.operator_plan is not None:
        safe = [message("offer.safe")] if offer.into_safe else []
        condition = end_sentence(automaton, offer.goal, offer.into_safe)
        yield message("offer.wait", conditions=[*safe, *([condition] if condition else [])])


def _by_people(automaton: Automaton, offer: RecoveryProposal) -> Iterator[Message]:
    """What people do at the station, as the model calls it where it does; last, what is then noted of the product."""
    changes = told(automaton, offer.physical)
    acts = [(change, sentences_of(automaton).call_by_hand(change.name, change.new)) for change in changes]
    called = [act for _, act in acts if act is not None]
    others = _so(automaton, [change for change, act in acts if act is None])
    records = _so(automaton, offer.records)
    if called and records and not others:
        yield message("offer.do-so", acts=called, records=records)
    elif called:
        yield message("offer.do", acts=called)
    if others and records:
        yield message("offer.see-to-so", changes=others, records=records)
    elif others:
        yield message("offer.see-to", changes=others)


def told(automaton: Automaton, changes: Iterable[ValueChange]) -> list[ValueChange]:
    """The changes that somebody brings about; the others come along with these."""
    every = list(changes)
    by_themselves = [each for each in every if not is_along(automaton, each.name, _as_new(each, every))]
    called = [each for each in by_themselves if sentences_of(automaton).tell_by_hand(each.name, each.new) is not None]
    return [each for each in by_themselves if each in called or not _comes_with_any(automaton, each, called)]


def _comes_with_any(automaton: Automaton, change: ValueChange, others: Collection[ValueChange]) -> bool:
    """Return whether one act of a device brings the change about together with one of the others."""
    for effect in automaton.effects:
        written = {target(each): each.value for each in effect.actions}
        brings = {name: value.value for name, value in written.items() if isinstance(value, Constant)}
        if brings.get(change.name) == change.new and any(brings.get(each.name) == each.new for each in others):
            return True
    return False


def _as_new(change: ValueChange, changes: Iterable[ValueChange]) -> list[str]:
    """The variables that become the same."""
    return [each.name for each in changes if each.new == change.new]


def _each(automaton: Automaton, changes: Iterable[ValueChange], what: str) -> list[Message]:
    said = sentences_of(automaton)
    return [
        message(what, name=said.call_variable(each.name), value=said.call_value(each.name, each.new))
        for each in changes
    ]


def _so(automaton: Automaton, changes: Iterable[ValueChange]) -> list[Message]:
    said = sentences_of(automaton)
    return [
        message(
            "offer.so",
            condition=said.tell_values([(each.name, each.new)], f"{each.name} is {print_value(each.new)}"),
        )
        for each in changes
    ]


def plan_preview(automaton: Automaton, plan: Plan, state: State) -> PlanPreviewView:
    """A plan as it is shown before anybody follows it, from `state`; what may start first stands first."""
    times = estimated_times(automaton, plan, state)
    steps = [_step(automaton, tick, name, times[index]) for index, (tick, name) in enumerate(plan.starts)]
    return PlanPreviewView(
        ticks=len(plan.ticks),
        steps=sorted(steps, key=lambda step: step.start),
        minimal_ticks=plan.minimal_ticks,
        minimal_starts=plan.minimal_starts,
    )


class _SpokenNames(WrittenNames):
    """What people call the parts of `automaton`; programs have them as they are written."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._said = sentences_of(automaton)

    def variable(self, name: str) -> Item:
        return self._said.call_variable(name)

    def so(self, name: str, value: bool | int | str, written: str) -> Item:
        return self._said.tell_values([(name, value)], written)

    def call_member(self, kind: MemberKind, name: str) -> Item:
        title = self._title(kind, name)
        return name if title is None else self._said.call_part(name, title)

    def _title(self, kind: MemberKind, name: str) -> str | None:
        automaton = self._automaton
        match kind:
            case MemberKind.OFFLINE:
                return automaton.resources.get(name)
            case MemberKind.BARRED:
                return automaton.abilities[name].title if name in automaton.abilities else None
            case MemberKind.LOCAL | MemberKind.GOAL:
                return automaton.operations[name].title if name in automaton.operations else None
            case MemberKind.SPECIFICATION:
                return automaton.specifications[name].title if name in automaton.specifications else None
            case MemberKind.VALUE | MemberKind.AVOID:
                return None


# What is to be seen to comes first, then what is not known because of it, and last what the model says.
_ORDER: Final = (MemberKind.OFFLINE, MemberKind.BARRED, MemberKind.GOAL, MemberKind.LOCAL, MemberKind.VALUE)


def _first_told(member: Member) -> tuple[int, bool]:
    order = _ORDER.index(member.part) if member.part in _ORDER else len(_ORDER)
    return order, member.value is not None


def diagnosis_view(
    automaton: Automaton, diagnosis: Diagnosis, out_of_service: Collection[str], answers: Collection[str] = ()
) -> DiagnosisView:
    """Return why something cannot be done, and what would help; resources that do nothing can be `out_of_service`.

    Nothing is said otherwise of estimates for which somebody has given `answers`, and what can be done comes first.
    """
    names = _SpokenNames(automaton)
    reason, helpful = diagnosis.reason, list[tuple[bool, Message]]()
    for correction in diagnosis.corrections:
        said = [change.name for change in correction.changes if change.value is not None]
        if not any(name in answers for name in said):
            text = correction_text(correction, out_of_service, names)
            helpful.append((bool(said), message("correction.checked", correction=text) if said else text))
    found = () if reason is None else sorted(reason.members, key=_first_told)
    members = [member_text(member, out_of_service, names) for member in found]
    corrections = [text for _, text in sorted(helpful, key=lambda each: each[0])]
    return DiagnosisView(
        members=[*members],
        minimal=reason is not None and reason.minimal,
        corrections=[*corrections],
        member_messages=members,
        correction_messages=corrections,
    )


def _step(automaton: Automaton, tick: int, name: str, times: tuple[float, float]) -> PreviewStepView:
    ability = automaton.abilities[name]
    return PreviewStepView(
        tick=tick,
        start=times[0],
        end=times[1],
        ability=name,
        title=ability.title,
        resource=ability.resource,
        human=ability.human is not None,
        restart=ability.restart,
        moves=ability.moves,
    )


def _tasks(automaton: Automaton, offer: RecoveryProposal) -> Mapping[str, Ability]:
    """Return the abilities by which a person does what is then corrected, by the estimates that are."""
    tasks = tasks_for(automaton)
    return {change.name: tasks[change.name, change.new] for change in offer.corrections if change.name in offer.by_hand}


NO_TASKS: Final[Mapping[str, Ability]] = MappingProxyType({})


def _changes(
    automaton: Automaton, changes: Sequence[ValueChange], tasks: Mapping[str, Ability] = NO_TASKS
) -> list[ValueChangeView]:
    return [
        ValueChangeView(
            name=change.name, now=change.old, then=change.new, so=so, by_hand=_by_hand(automaton, change, tasks)
        )
        for change, so in zip(changes, _so(automaton, changes), strict=True)
    ]


def _by_hand(automaton: Automaton, change: ValueChange, tasks: Mapping[str, Ability]) -> Message | None:
    if (task := tasks.get(change.name)) is not None and task.human is not None:
        return message("offer.by-hand", how=task.human.text)
    how = sentences_of(automaton).tell_by_hand(change.name, change.new)
    return None if how is None else message("offer.by-hand", how=how)


# Why an offer cannot be made, or not be taken.


def refusal_of(offer: RecoveryProposal, execution: Executor) -> CommandRefused | None:
    """Return why an offer for the present state cannot be taken now; None when it can."""
    if execution.operator_plan is not None:
        return plan_running(execution.operator_plan.title)
    if offer.physical or offer.online or offer.in_service:
        return CommandRefused("manual-step-required", message("refused.manual-step-required.station"))
    if offer.operator_plan is None:
        if offer.corrections:
            return correcting_refused(execution)
        return CommandRefused("nothing-to-execute", message("refused.nothing-to-execute.restart"))
    if execution.production is not Production.STARTED:
        return CommandRefused("production-not-started", message("refused.production-not-started.offer"))
    return _wrong_mode(offer, execution.mode)


def correcting_refused(execution: Executor) -> CommandRefused | None:
    """Return why no correction can be made now; None when one can."""
    if execution.operator_plan is not None:
        return plan_running(execution.operator_plan.title)
    if execution.mode is not Mode.RESTART and execution.production is Production.STARTED:
        return CommandRefused("not-in-restart", message("refused.not-in-restart.correct"))
    return None


def _wrong_mode(offer: RecoveryProposal, mode: Mode) -> CommandRefused | None:
    if mode is Mode.RESTART or (mode is Mode.PAUSED and not needs_restart(offer)):
        return None
    id_ = "refused.wrong-mode.restart" if needs_restart(offer) else "refused.wrong-mode.paused"
    return CommandRefused("wrong-mode", message(id_, mode=message(f"mode.{mode}")))


def plan_running(title: str) -> CommandRefused:
    """Nothing is offered beside an operator plan: the state moves with it."""
    return CommandRefused("plan-running", message("refused.plan-running.title", title=title_text(title)))


# Predicates that come with a request, in the model's language.


def read_predicate(automaton: Automaton, text: str) -> Expression:
    """Return what `text` means, with all names in full. Raises `CommandRefused`, which names the place."""
    try:
        return automaton.read_condition(text)
    except ExpressionError as error:
        start, end = error.span
        place = TextPlace(start=start, end=end, message=error.message)
        said: dict[str, Argument] = {"character": start + 1, "why": as_it_was(error.message)}
        if text[start:end].strip():
            detail = message("refused.bad-predicate.text", text=text[start:end], **said)
        else:
            detail = message("refused.bad-predicate.at", **said)
        raise CommandRefused("bad-predicate", detail, 422, place=place) from None


# How a sentence ends that says that there is no such name.


def hint_of(word: str, known: Iterable[str], otherwise: str = ".") -> Message:
    """Return how a sentence ends that says that there is no such name: with the nearest that is known."""
    return as_it_was(suggestion(word, known) or otherwise, "hint.")
