"""Whose connection is closed when there are too many, whatever comes and goes."""

from __future__ import annotations

import asyncio

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.server.http import middleware
from sequence_planner.server.http.middleware import ConnectionKind, Crowd, Group, group_of_address


class Closing(asyncio.Transport):
    """A transport that knows whether it was closed."""

    closed = False

    def abort(self) -> None:
        self.closed = True


GROUPS = st.sampled_from(
    [(kind, name) for kind in ConnectionKind for name in "abc"],
)


@given(st.lists(st.tuples(st.integers(0, 20), st.none() | GROUPS), max_size=60))
def test_nobody_has_more_than_their_part_and_strangers_cost_nobody_who_is_known(
    steps: list[tuple[int, Group | None]],
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(middleware, "MOST_UNKNOWN", 6)
        patch.setattr(middleware, "MOST_KNOWN", 5)
        patch.setattr(
            middleware, "MOST_OF_ONE", {ConnectionKind.ADDRESS: 3, ConnectionKind.PROXY: 6, ConnectionKind.BEARER: 4}
        )
        everybody = Crowd()
        transports: dict[int, Closing] = {}
        groups: dict[int, Group] = {}
        for number, group in steps:
            if group is None:
                if number in transports:
                    everybody.leave(transports.pop(number))
                    del groups[number]
                continue
            before = set(transports)
            transport = transports.setdefault(number, Closing())
            groups[number] = group
            everybody.put(transport, group)
            closed = {each for each, one in transports.items() if one.closed}
            assert len(closed) <= 1
            assert closed <= before  # a newcomer finds a place
            for each in closed:
                assert (groups[each][0] is ConnectionKind.BEARER) == (group[0] is ConnectionKind.BEARER)
                del transports[each], groups[each]
            sizes = [list(groups.values()).count(each) for each in set(groups.values())]
            assert all(
                size <= middleware.MOST_OF_ONE[each[0]] for each, size in zip(set(groups.values()), sizes, strict=True)
            )
            known = sum(each[0] is ConnectionKind.BEARER for each in groups.values())
            assert known <= 5
            assert len(groups) - known <= 6


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("192.0.2.7", "::ffff:192.0.2.7", True),
        ("192.0.2.7", "192.0.2.8", False),
        ("2001:db8::1", "2001:db8::ffff:1", True),
        ("2001:db8::1", "2001:db8:0:1::1", False),
        ("fe80::1%eth0", "fe80::2%eth0", True),
        ("::1", "::2", False),
    ],
)
def test_of_ipv6_a_network_counts_as_one(one: str, other: str, same: bool) -> None:
    assert (group_of_address(one) == group_of_address(other)) is same
