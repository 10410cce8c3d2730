"""What the names of a draft mean, and where they are used: for renaming and deleting a part of a model, and for
seeing it as a whole.
"""

from sequence_planner.workshop.references.finding import Usage, Usages, dependants, usages
from sequence_planner.workshop.references.parts import KINDS, Part, parse_part
from sequence_planner.workshop.references.renaming import renamed
from sequence_planner.workshop.references.whole import Graph, graph, station_of

__all__ = [
    "KINDS",
    "Graph",
    "Part",
    "Usage",
    "Usages",
    "dependants",
    "graph",
    "parse_part",
    "renamed",
    "station_of",
    "usages",
]
