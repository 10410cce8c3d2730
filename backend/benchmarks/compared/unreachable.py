"""Questions without an answer, which the delete relaxation does not see: each variable can take each of its values."""

from __future__ import annotations

from dataclasses import replace

from compared.declaring import Declared, Does, Problem

from sequence_planner.automaton.automaton import Kind
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis.supervisor import synthesise


def mutex(users: int) -> Problem:
    """Carriages that follow their commands share a section of track, and two are wanted in it at once."""
    station = Declared(f"mutex-{users}")
    station.variable("track", "free", Kind.ESTIMATED, BOOLEAN, True)
    for user in (f"carriage_{number}" for number in range(users)):
        station.variable(user, "place", Kind.MEASURED, ("outside", "moving", "inside"), "outside")
        station.variable(user, "target", Kind.OUTPUT, ("outside", "inside"), "outside")
        target, place = f"{user}.target", f"{user}.place"
        enter = Does(
            (f"{target} := inside", "track.free := false"),
            f"track.free and {target} == outside and {place} == outside",
            f"{target} == inside and {place} != inside",
            f"{target} == inside and {place} == inside",
        )
        leave = Does(
            (f"{target} := outside",),
            f"{target} == inside and {place} == inside",
            f"{target} == outside and {place} != outside",
            f"executing and {place} == outside",
            ("track.free := true",),
        )
        station.ability(user, "enter", enter)
        station.ability(user, "leave", leave)
        station.effect(user, "departs", f"{target} != {place} and {place} != moving", f"{place} := moving")
        for stop in ("outside", "inside"):
            station.effect(user, f"arrives_{stop}", f"{target} == {stop} and {place} == moving", f"{place} := {stop}")
    return station.problem({"both": {"both": "carriage_0.place == inside and carriage_1.place == inside"}})


def blocked(gates: int) -> Problem:
    """A long part passes a gate only while the next is open too; a specification forbids that of two in the middle."""
    station = Declared(f"blocked-{gates}")
    part = station.variable("part", "place", Kind.MEASURED, gates, 0)
    for gate in (f"gate_{number}" for number in range(gates + 1)):
        station.variable(gate, "open", Kind.OUTPUT, BOOLEAN, False)
        station.variable(gate, "opened", Kind.MEASURED, BOOLEAN, False)
        opened, command = f"{gate}.opened", f"{gate}.open"
        opens = Does((f"{command} := true",), f"not {command} and not {opened}", f"{command} and not {opened}", opened)
        closes = Does(
            (f"{command} := false",), f"{command} and {opened}", f"not {command} and {opened}", f"not {opened}"
        )
        station.ability(gate, "opens", opens)
        station.ability(gate, "closes", closes)
        station.effect(gate, "up", f"{command} and not {opened}", f"{opened} := true")
        station.effect(gate, "down", f"not {command} and {opened}", f"{opened} := false")
    for number in range(gates):
        both = f"gate_{number}.opened and gate_{number + 1}.opened"
        station.effect("part", f"passes_{number}", f"{part} == {number} and {both}", f"{part} := {number + 1}")
    middle = gates // 2
    one, other = (f"(gate_{number}.open or gate_{number}.opened)" for number in (middle, middle + 1))
    station.forbid("never_both", f"{one} and {other}")
    problem = station.problem({"through": {"through": f"{part} == {gates}"}})
    return replace(problem, supervisor=synthesise(problem.automaton))


def capacity(slots: int) -> Problem:
    """A magazine is to hold one product more than it has slots."""
    station = Declared(f"capacity-{slots}")
    products = [f"product_{number}" for number in range(slots + 1)]
    places = [f"slot_{number}" for number in range(slots)]
    for place in places:
        station.variable("magazine", place, Kind.ESTIMATED, BOOLEAN, False)
    station.variable("arm", "busy", Kind.OUTPUT, BOOLEAN, False)
    station.variable("arm", "done", Kind.MEASURED, BOOLEAN, False)
    station.effect("arm", "acts", "arm.busy and not arm.done", "arm.done := true")
    station.effect("arm", "rests", "not arm.busy and arm.done", "arm.done := false")
    ready = "not arm.busy and not arm.done"
    station.ability("arm", "rest", Does(("arm.busy := false",), "arm.busy and arm.done"))
    for product in products:
        at = station.variable(product, "at", Kind.ESTIMATED, ("outside", *places), "outside")
        for place in places:
            taken = f"magazine.{place}"
            store = Does(
                (f"{at} := {place}", f"{taken} := true", "arm.busy := true"),
                f"{ready} and {at} == outside and not {taken}",
            )
            fetch = Does((f"{at} := outside", f"{taken} := false", "arm.busy := true"), f"{ready} and {at} == {place}")
            station.ability(product, f"into_{place}", store)
            station.ability(product, f"out_of_{place}", fetch)
    everything = " and ".join(f"{product}.at != outside" for product in products)
    return station.problem({"all": {"all": everything}})
