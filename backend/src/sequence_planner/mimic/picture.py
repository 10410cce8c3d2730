"""The live picture of a station: that of its `mimic.yaml`, or one made from the model."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.findings import Findings
from sequence_planner.mimic.drawn import as_shown, drawn
from sequence_planner.mimic.layout import made_from
from sequence_planner.mimic.views import MimicView
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding


def picture_of(automaton: Automaton, station: Station | None) -> MimicView:
    """The picture of a station; a station that nobody has written has one, too."""
    if station is None:
        return made_from(automaton)
    findings = Findings()
    findings.all += station.undrawn
    if station.mimic is not None:
        return drawn(automaton, station.mimic, station.drawings, findings)
    return made_from(automaton).model_copy(update={"findings": as_shown(findings)})


def undrawn_of(automaton: Automaton, station: Station) -> list[Finding]:
    """What of `mimic.yaml` cannot be drawn."""
    findings = Findings()
    findings.all += station.undrawn
    if station.mimic is not None:
        drawn(automaton, station.mimic, station.drawings, findings)
    return sorted(set(findings.all))
