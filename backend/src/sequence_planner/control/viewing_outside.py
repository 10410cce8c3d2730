"""What is shown of a station outside its safe states."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.outside import Outside
from sequence_planner.control.way_back_view import DifferenceView, SpecificationView, WayBackStepView, WayBackView
from sequence_planner.planning.plan import WayBack, WayBackAnswer


def way_back(automaton: Automaton, outside: Outside, feeds: Mapping[str, str]) -> WayBackView | None:
    """None while the state is safe. `feeds` names the topic behind each measured variable."""
    situation = outside.situation
    if situation is None:
        return None

    def named(specifications: tuple[str, ...]) -> list[SpecificationView]:
        return [SpecificationView(name=name, title=automaton.specifications[name].title) for name in specifications]

    awaits = sorted({feeds.get(name, name) for name in situation.awaited})
    answer = outside.answer if situation.certain else None
    found = answer if isinstance(answer, WayBackAnswer) else None
    way = found.way if found is not None else None
    return WayBackView(
        violated=named(situation.violated),
        threatened=named(found.threatened) if found is not None else [],
        differences=[DifferenceView(name=d.name, now=d.now, safe=d.safe) for d in situation.differences],
        awaits=awaits,
        ticks=len(way.ticks) if way is not None else None,
        steps=_steps(automaton, way) if way is not None else [],
        breaks=named(way.breaks) if way is not None else [],
        reason=outside.way() if situation.certain else f"Whether the state is safe depends on {', '.join(awaits)}.",
    )


def _steps(automaton: Automaton, way: WayBack) -> list[WayBackStepView]:
    abilities = [(tick, automaton.abilities[name]) for tick, name in way.starts]
    return [WayBackStepView(tick=tick, ability=a.name, title=a.title, resource=a.resource) for tick, a in abilities]
