"""Orders of variables for decision diagrams."""

from __future__ import annotations

from itertools import pairwise

from sequence_planner.synthesis.bdd import hubs_first


def test_what_many_others_are_about_stands_before_them() -> None:
    bolts = [f"bolt_{number}" for number in range(6)]
    groups = [{"pose", bolt} for bolt in bolts]
    assert hubs_first((*bolts[:3], "pose", *bolts[3:]), groups) == ("pose", *bolts)


def test_what_has_nothing_to_do_with_a_hub_is_not_parted_by_it() -> None:
    """Robots that meet in one place stay beside their own bolts, and are not drawn together before all of them."""
    stations = [[f"pose_{station}", *(f"bolt_{station}_{number}" for number in range(6))] for station in range(3)]
    groups = [{bolts[0], bolt} for bolts in stations for bolt in bolts[1:]]
    groups += [{one[0], other[0]} for one, other in pairwise(stations)]
    order = [name for pose, *bolts in stations for name in (*bolts, pose)]
    assert hubs_first(order, groups) == tuple(name for station in stations for name in station)
