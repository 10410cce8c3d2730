"""Running a whole station, and the server alone. What keeps one from running is said with exit code 2."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import DatabaseOption, StationFolder, database_url, refuse
from sequence_planner.cli.parts import (
    Launched,
    RosbridgeOption,
    Socket,
    TransportOption,
    begin,
    prepare,
)
from sequence_planner.mes.webhooks.targets import TargetRefused, Targets, host_and_port
from sequence_planner.storage.environment import DATABASE
from sequence_planner.storage.error import StorageError
from sequence_planner.web.settings import Endpoint, Settings, SettingsError

Host = Annotated[
    str, typer.Option(help="Address where the page is served; beyond the loopback with a certificate or a proxy only.")
]
Port = Annotated[int, typer.Option(help="Port of the page.")]
Certificate = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Serve by HTTPS with this certificate (PEM, with its chain).")
]
PrivateKey = Annotated[Path | None, typer.Option(metavar="FILE", help="The private key of the certificate (PEM).")]
Proxies = Annotated[
    list[str] | None,
    typer.Option(
        "--proxy",
        metavar="ADDRESS",
        help="Serve only this reverse proxy, which speaks HTTPS to the outside; can be repeated.",
    ),
]
Names = Annotated[
    list[str] | None,
    typer.Option("--name", metavar="HOST[:PORT]", help="A name by which people open the page; can be repeated."),
]
WebhookHosts = Annotated[
    list[str] | None,
    typer.Option(
        "--webhook-host",
        metavar="HOST[:PORT]",
        help="A host that webhooks may go to, by HTTPS and not within a private network; can be repeated.",
    ),
]
WebhookLoopback = Annotated[
    bool,
    typer.Option("--webhook-loopback", help="Such a host may be this machine too, and be reached by HTTP there."),
]
Demonstration = Annotated[
    bool,
    typer.Option(
        "--demonstration",
        help="Nobody has to sign in, and what was recorded is forgotten at the end; only with --emulator, here.",
    ),
]


def run(
    model: StationFolder,
    host: Host = "127.0.0.1",
    port: Port = 8000,
    certificate: Certificate = None,
    private_key: PrivateKey = None,
    proxy: Proxies = None,
    name: Names = None,
    database: DatabaseOption = None,
    transport: TransportOption = "auto",
    rosbridge: RosbridgeOption = None,
    emulator: Annotated[bool, typer.Option("--emulator", help="Run emulated devices beside it.")] = False,
    start: Annotated[bool, typer.Option("--start", help="Start production at once; only with --emulator.")] = False,
    emulator_speed: Annotated[float, typer.Option(min=0.1, max=100, help="Emulated devices go so much faster.")] = 1.0,
    demonstration: Demonstration = False,
    webhook_host: WebhookHosts = None,
    webhook_loopback: WebhookLoopback = False,
) -> None:
    """Run a station: controller, server and page."""
    from sequence_planner.launcher import Launch, launch  # noqa: PLC0415

    if start and not emulator:
        refuse("--start is for emulated devices: with real ones a person starts production on the page")
    endpoint = Endpoint(
        host=host,
        port=port,
        certificate=certificate,
        private_key=private_key,
        proxies=tuple(proxy or ()),
        names=tuple(name or ()),
    )
    if demonstration and not emulator:
        refuse("--demonstration is for emulated devices, which nobody has to sign in for: give --emulator, or leave it")
    if demonstration and database is not None:
        refuse(f"--demonstration has a database of its own, forgotten at the end: leave --database and {DATABASE} out")
    webhooks = _targets(webhook_host, webhook_loopback)
    prepare(model)
    url = None if demonstration else database_url(model, database)
    try:
        asked = Launch(model, endpoint, url, transport, rosbridge, emulator, start, emulator_speed, webhooks)
        raise typer.Exit(launch(asked))
    except (SettingsError, StorageError) as error:
        refuse(str(error))


def server(
    socket: Socket,
    page: Annotated[Path, typer.Option()],
    model: Annotated[Path, typer.Option()],
    transport: TransportOption = "auto",
    host: Host = "127.0.0.1",
    port: Port = 8000,
    certificate: Certificate = None,
    private_key: PrivateKey = None,
    proxy: Proxies = None,
    name: Names = None,
    database: DatabaseOption = None,
    demonstration: Demonstration = False,
    webhook_host: WebhookHosts = None,
    webhook_loopback: WebhookLoopback = False,
    launched: Launched = False,
) -> None:
    """Run the server alone; `run` does this."""
    from sequence_planner.web.server import serve  # noqa: PLC0415

    begin(launched, socket.parent)
    serve(
        Settings(
            controller_socket=socket,
            page=page,
            database=database_url(model, database),
            host=host,
            port=port,
            certificate=certificate,
            private_key=private_key,
            proxies=tuple(proxy or ()),
            names=tuple(name or ()),
            model=model,
            transport=transport,
            demonstration=demonstration,
            webhooks=_targets(webhook_host, webhook_loopback),
        )
    )


def _targets(hosts: list[str] | None, loopback: bool) -> Targets:
    try:
        return Targets(frozenset(map(host_and_port, hosts or ())), loopback)
    except TargetRefused as refused:
        refuse(f"--webhook-host: {refused}")
