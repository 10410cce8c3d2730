"""What is shown of a model as a whole."""

from __future__ import annotations

from sequence_planner.analysis.document import FindingDocument, error_document
from sequence_planner.control.view_part import View
from sequence_planner.workshop.references.manner import Manner
from sequence_planner.workshop.references.parts import Part
from sequence_planner.workshop.references.whole import Graph, Standing, Thing

STATION = "station"
_OPERATIONS = 2  # the layer on which the states of rest are


class ThingView(View):
    """Something with a name: `id` is that of a part, such as `variable:robot.pose`, or `station` for the station.

    `layer` is that of the paper: 0 ROS 2, 1 abilities and estimates, 2 operations and specifications, 3 the order of
    work. `within` is the index of the thing that it is a part of, as a value is of an enumeration. File, line and
    column are where it is declared, or else first used; the file is null where it is given.
    """

    id: str
    kind: str
    name: str
    title: str | None
    layer: int
    standing: Standing
    resource: str | None
    section: str | None
    within: int | None
    file: str | None
    line: int
    column: int


class TieView(View):
    """A use of the thing with index `thing` by that with index `by`, at the entry `at` within that.

    `written` is false where no text names it: then a field of a message has its name, and line and column are of `by`.
    """

    thing: int
    by: int
    manner: Manner
    at: str
    file: str
    line: int
    column: int
    written: bool


class GraphView(View):
    """All things of the draft after its change `number`, and all ties between them; `unread` could not be read."""

    number: int
    things: list[ThingView]
    ties: list[TieView]
    unread: list[FindingDocument]


def graph_view(number: int, graph: Graph, name: str, title: str | None) -> GraphView:
    """The view of a graph of a station."""
    station = ThingView(
        id=STATION, kind=STATION, name=name, title=title, layer=_OPERATIONS, standing=Standing.DECLARED, resource=None,
        section=None, within=None, file="station.yaml", line=1, column=1,
    )  # fmt: skip
    index: dict[Part | None, int] = {None: 0}
    index |= {thing.part: number for number, thing in enumerate(graph.things, start=1)}
    return GraphView(
        number=number,
        things=[station, *(_thing(each, index) for each in graph.things)],
        ties=[
            TieView(
                thing=index[each.part],
                by=index[each.by],
                manner=each.manner,
                at=each.entry,
                file=each.file,
                line=each.line,
                column=each.column,
                written=each.written,
            )
            for each in graph.ties
        ],
        unread=[error_document(each) for each in (*graph.skipped, *graph.unread)],
    )


def _thing(thing: Thing, index: dict[Part | None, int]) -> ThingView:
    place = thing.place
    return ThingView(
        id=thing.part.id,
        kind=thing.part.kind,
        name=thing.part.full.rpartition(":")[2],
        title=thing.title,
        layer=thing.layer,
        standing=thing.standing,
        resource=thing.resource,
        section=thing.section,
        within=None if thing.within is None else index.get(thing.within),
        file=None if place is None else place.file,
        line=1 if place is None else place.line,
        column=1 if place is None else place.column,
    )
