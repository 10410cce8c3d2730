"""The options of `run` that do not go together, or mean nothing. Each complaint names the options it is about."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

from sequence_planner.core.storage_error import DATABASE
from sequence_planner.mes.webhooks.targets import TargetRefused, Targets, host_and_port, network

HOT_STANDBY: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9.-]{0,59}")


def wrong_together(
    *,
    emulator: bool,
    start: bool,
    demonstration: bool,
    database: bool,
    database_file: bool,
    hot_standby: str | None,
    provider: bool,
) -> Iterator[str]:
    """Say why a station cannot be run so; of the database and the provider only whether one is named."""
    if start and not emulator:
        yield "--start is for emulated devices: with real ones a person starts production on the page"
    if demonstration and not emulator:
        yield "--demonstration is for emulated devices, which nobody has to sign in for: give --emulator, or leave it"
    if database and database_file:
        yield "the database is named twice: give --database or --database-file"
    if demonstration and (database or database_file):
        yield f"--demonstration has a database of its own, forgotten at the end: leave --database and {DATABASE} out"
    if hot_standby is not None and (demonstration or not HOT_STANDBY.fullmatch(hot_standby)):
        yield "--hot-standby takes a name of up to 60 letters, digits, dots and hyphens, and is not for demonstrations"
    if provider and demonstration:
        yield "--demonstration is for whoever sits here, and nobody signs in: leave --oidc-issuer out, or it"


def webhook_targets(hosts: Sequence[str], networks: Sequence[str], loopback: bool) -> tuple[Targets, list[str]]:
    """Return where webhooks may go to, and what is wrong with what was named."""
    wrong: list[str] = []
    found_hosts, found_networks = set(), []
    for each in hosts:
        try:
            found_hosts.add(host_and_port(each))
        except TargetRefused as refused:
            wrong.append(f"--webhook-host: {refused}")
    for each in networks:
        try:
            found_networks.append(network(each))
        except TargetRefused as refused:
            wrong.append(f"--webhook-network: {refused}")
    return Targets(frozenset(found_hosts), loopback, tuple(dict.fromkeys(found_networks))), wrong
