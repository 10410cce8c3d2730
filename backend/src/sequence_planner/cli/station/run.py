"""`run` and `server`: start the whole station or the server alone, with the options of OpenID Connect."""

from __future__ import annotations

import os
from pathlib import Path
from socket import socket as ListeningSocket  # noqa: N812 - the option `socket` is a path
from typing import Annotated

import typer

from sequence_planner.auth.oidc.options import ProviderOptionError, ProviderOptions
from sequence_planner.auth.oidc.settings import NO_OTHERS, ProviderSettings
from sequence_planner.backup.settings import KEPT, Keeping
from sequence_planner.cli.configuration_option import ConfigurationOption
from sequence_planner.cli.options import (
    USUAL_MEMORY,
    DatabaseOption,
    Memory,
    StationFolder,
    database_url,
    is_typed,
    refuse,
)
from sequence_planner.cli.part_options import Launched, RosbridgeOption, Socket, TransportOption, begin
from sequence_planner.cli.station.option_conflicts import webhook_targets, wrong_together
from sequence_planner.controller.deployment_folder import DeploymentNote, undo_what_was_cut_off
from sequence_planner.core.logging import LogFormat
from sequence_planner.core.secrets import CLIENT_SECRET
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.mes.webhooks.targets import Targets
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.retention.settings import (
    JOURNAL_DAYS,
    JOURNAL_GB,
    LEAST_ORDER_DAYS,
    MOST_DAYS,
    MOST_GB,
    NO_ARCHIVE,
    ORDER_DAYS,
    Retention,
)
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.choice import TransportChoice, settled
from sequence_planner.server.settings import LARGEST_RECORDING, Endpoint, Settings, SettingsError
from sequence_planner.settings import ConfigurationError, has_password, url_in

# The options of `run` about the provider with which people sign in, and what they mean.

PREFIX = "SEQUENCE_PLANNER_OIDC_"

Issuer = Annotated[
    str | None,
    typer.Option(
        "--oidc-issuer",
        envvar=f"{PREFIX}ISSUER",
        metavar="URL",
        help="Let people sign in with this provider of OpenID Connect, beside passwords.",
    ),
]
Client = Annotated[
    str | None,
    typer.Option(
        "--oidc-client",
        envvar=f"{PREFIX}CLIENT",
        metavar="ID",
        help="As which client the provider knows this station.",
    ),
]
SecretFile = Annotated[
    Path | None,
    typer.Option(
        "--oidc-client-secret-file",
        envvar=f"{PREFIX}CLIENT_SECRET_FILE",
        metavar="FILE",
        help=f"Where the client's secret is, in one line; or it is in the variable {PREFIX}CLIENT_SECRET.",
    ),
]
Title = Annotated[
    str | None,
    typer.Option(
        "--oidc-title",
        envvar=f"{PREFIX}TITLE",
        metavar="TEXT",
        help="What people call the provider; else its host name.",
    ),
]
Scopes = Annotated[
    list[str] | None,
    typer.Option(
        "--oidc-scope",
        envvar=f"{PREFIX}SCOPE",
        metavar="SCOPE",
        help="What is asked for beside openid; can be repeated. By default profile.",
    ),
]
Groups = Annotated[
    str,
    typer.Option(
        "--oidc-groups-claim",
        envvar=f"{PREFIX}GROUPS_CLAIM",
        metavar="CLAIM",
        help="The claim with a person's groups, as in realm_access.roles.",
    ),
]
Roles = Annotated[
    list[str] | None,
    typer.Option(
        "--oidc-role",
        envvar=f"{PREFIX}ROLE",
        metavar="ROLE=GROUP",
        help="The role here of people in a group there; can be repeated, and of several the highest counts.",
    ),
]
Others = Annotated[
    str,
    typer.Option(
        "--oidc-others",
        envvar=f"{PREFIX}OTHERS",
        metavar="refused|viewer",
        help="What becomes of people in none of these groups.",
    ),
]


# Running a whole station, and the server alone. What keeps one from running is said with exit code 2.

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
WallBeside = Annotated[
    list[str] | None,
    typer.Option(
        "--wall-beside",
        metavar="URL",
        help="Another station, whose wall stands beside this one's, and this one's beside that one's; can be repeated.",
    ),
]
_NICENESS = 2  # of the server: ticks come before whoever looks on
WebhookHosts = Annotated[
    list[str] | None,
    typer.Option(
        "--webhook-host",
        metavar="HOST[:PORT]",
        help="A host that webhooks may go to, by HTTPS; can be repeated.",
    ),
]
WebhookNetworks = Annotated[
    list[str] | None,
    typer.Option(
        "--webhook-network",
        metavar="NETWORK",
        help="A network of the plant that webhooks may go to, by HTTPS, as in 10.1.2.0/24; can be repeated.",
    ),
]
WebhookLoopback = Annotated[
    bool,
    typer.Option("--webhook-loopback", help="Such a host may be this machine too, and be reached by HTTP there."),
]
BackupFolder = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="Where backups are kept, a folder that is there. By default one beside the database, made with the first.",
    ),
]
BackupsKept = Annotated[
    int, typer.Option(min=1, max=1000, help="How many backups are kept; the oldest go, but only for one that is whole.")
]
BackupEvery = Annotated[
    float | None,
    typer.Option(
        min=0.25, max=8760, metavar="HOURS", help="Make a backup every so many hours; by default when asked only."
    ),
]
JournalDays = Annotated[
    float,
    typer.Option(min=0.01, max=MOST_DAYS, metavar="DAYS", help="How long what happened stays in the database."),
]
JournalGb = Annotated[
    float,
    typer.Option(min=0.001, max=MOST_GB, metavar="GB", help="How much of what happened stays in it, if that is less."),
]
OrderDays = Annotated[
    float,
    typer.Option(
        min=LEAST_ORDER_DAYS, max=MOST_DAYS, metavar="DAYS", help="How long job orders stay in it after they are over."
    ),
]
ArchiveFolder = Annotated[
    str | None,
    typer.Option(
        metavar="FOLDER",
        help="Where all that goes to then, a folder that is there; by default one beside the database. "
        f"{NO_ARCHIVE}: it is gone for good.",
    ),
]
ArchiveDays = Annotated[
    float | None,
    typer.Option(
        min=1, max=MOST_DAYS, metavar="DAYS", help="Remove what is older from the archive; by default nothing is."
    ),
]
ArchiveGb = Annotated[
    float | None,
    typer.Option(
        min=0.001, max=MOST_GB, metavar="GB", help="Remove the oldest from an archive with more; by default nothing is."
    ),
]
LargestRecording = Annotated[
    int,
    typer.Option(
        min=1,
        max=100_000,
        metavar="MB",
        help="How large a recording may be that What-if is to begin from, as it comes and unpacked.",
    ),
]
Demonstration = Annotated[
    bool,
    typer.Option(
        "--demonstration",
        help="Nobody has to sign in, and what was recorded is forgotten at the end; only with --emulator, here.",
    ),
]


def run(
    context: typer.Context,
    model: StationFolder,
    configuration: ConfigurationOption = None,
    host: Host = "127.0.0.1",
    port: Port = 8000,
    certificate: Certificate = None,
    private_key: PrivateKey = None,
    proxy: Proxies = None,
    name: Names = None,
    wall_beside: WallBeside = None,
    database: DatabaseOption = None,
    database_file: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A file that holds the database's URL, with its password.")
    ] = None,
    transport: TransportOption = "auto",
    rosbridge: RosbridgeOption = None,
    emulator: Annotated[bool, typer.Option("--emulator", help="Run emulated devices beside it.")] = False,
    start: Annotated[bool, typer.Option("--start", help="Start production at once; only with --emulator.")] = False,
    emulator_speed: Annotated[float, typer.Option(min=0.1, max=100, help="Emulated devices go so much faster.")] = 1.0,
    demonstration: Demonstration = False,
    hot_standby: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Share a database of PostgreSQL with other stations for the same devices, of which one commands; "
            "NAME is what this one is called.",
        ),
    ] = None,
    oidc_issuer: Issuer = None,
    oidc_client: Client = None,
    oidc_client_secret_file: SecretFile = None,
    oidc_title: Title = None,
    oidc_scope: Scopes = None,
    oidc_groups_claim: Groups = "groups",
    oidc_role: Roles = None,
    oidc_others: Others = NO_OTHERS,
    log_format: Annotated[LogFormat, typer.Option(help="Write events as text for people or as JSON.")] = LogFormat.TEXT,
    webhook_host: WebhookHosts = None,
    webhook_network: WebhookNetworks = None,
    webhook_loopback: WebhookLoopback = False,
    backup_folder: BackupFolder = None,
    backups_kept: BackupsKept = KEPT,
    backup_every: BackupEvery = None,
    journal_days: JournalDays = JOURNAL_DAYS,
    journal_gb: JournalGb = JOURNAL_GB,
    order_days: OrderDays = ORDER_DAYS,
    archive_folder: ArchiveFolder = None,
    archive_days: ArchiveDays = None,
    archive_gb: ArchiveGb = None,
    largest_recording: LargestRecording = LARGEST_RECORDING,
    new: Annotated[
        bool,
        typer.Option(
            "--new", help="A new station is meant to begin, though another one has left files beside its database."
        ),
    ] = False,
    memory: Memory = USUAL_MEMORY,
) -> None:
    """Run a station: controller, server and page."""
    from sequence_planner.launcher import Launch, launch  # noqa: PLC0415

    endpoint = Endpoint(
        host=host,
        port=port,
        certificate=certificate,
        private_key=private_key,
        proxies=tuple(proxy or ()),
        names=tuple(name or ()),
        wall_beside=tuple(wall_beside or ()),
    )
    wrong = wrong_together(
        emulator=emulator,
        start=start,
        demonstration=demonstration,
        database=database is not None,
        database_file=database_file is not None,
        hot_standby=hot_standby,
        provider=oidc_issuer is not None,
    )
    for each in wrong:
        refuse(each)
    if database is not None and has_password(database) and is_typed(context, "database"):
        refuse(
            "everybody on this machine can read a password on the command line: give the database's URL in "
            f"--database-file, in the --configuration or in {DATABASE}"
        )
    if database_file is not None:
        database = _url_in(database_file)
    provider = ProviderOptions(
        issuer=oidc_issuer,
        client=oidc_client,
        secret_file=oidc_client_secret_file,
        title=oidc_title,
        scopes=tuple(oidc_scope or ()),
        groups=oidc_groups_claim,
        roles=tuple(oidc_role or ()),
        others=oidc_others,
    )
    _provider(provider)
    webhooks = _targets(webhook_host, webhook_network, webhook_loopback)
    cut_off = _undone(model)
    url = None if demonstration else database_url(model, database)
    asked = Launch(
        model,
        endpoint,
        url,
        _settled(transport),
        rosbridge,
        emulator,
        start,
        emulator_speed,
        hot_standby=hot_standby,
        provider=provider,
        log_format=log_format,
        webhooks=webhooks,
        backups=Keeping(backup_folder, backups_kept, backup_every),
        retention=Retention.from_options(
            journal_days, journal_gb, order_days, archive_folder, archive_days, archive_gb
        ),
        largest_recording=largest_recording,
        new=new,
        memory=memory,
        cut_off=cut_off,
    )
    try:
        raise typer.Exit(launch(asked))
    except SettingsError as error:
        refuse(str(error))


def _settled(transport: TransportChoice) -> TransportChoice:
    """The transport for all parts."""
    try:
        return settled(transport, lambda text: typer.echo(text, err=True))
    except TransportError as error:
        refuse(str(error))


def _undone(model: Path) -> DeploymentNote | None:
    """The deployment that an earlier `run` has not come to the end of, undone; said, since it changes files."""
    try:
        note = undo_what_was_cut_off(model)
    except OSError as error:
        refuse(f"{model}: a deployment was cut off, and its files cannot be brought back: {error.strerror}")
    if note is not None:
        typer.echo(f"the deployment of {note.name} was cut off: the model is as it was before", err=True)
    return note


def _url_in(file: Path) -> str:
    try:
        return url_in(file)
    except ConfigurationError as error:
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
    wall_beside: WallBeside = None,
    database: DatabaseOption = None,
    demonstration: Demonstration = False,
    emulated: Annotated[bool, typer.Option("--emulated")] = False,
    rosbridge: RosbridgeOption = None,
    oidc_issuer: Issuer = None,
    oidc_client: Client = None,
    oidc_client_secret_file: SecretFile = None,
    oidc_title: Title = None,
    oidc_scope: Scopes = None,
    oidc_groups_claim: Groups = "groups",
    oidc_role: Roles = None,
    oidc_others: Others = NO_OTHERS,
    webhook_host: WebhookHosts = None,
    webhook_network: WebhookNetworks = None,
    webhook_loopback: WebhookLoopback = False,
    backup_folder: BackupFolder = None,
    backups_kept: BackupsKept = KEPT,
    backup_every: BackupEvery = None,
    journal_days: JournalDays = JOURNAL_DAYS,
    journal_gb: JournalGb = JOURNAL_GB,
    order_days: OrderDays = ORDER_DAYS,
    archive_folder: ArchiveFolder = None,
    archive_days: ArchiveDays = None,
    archive_gb: ArchiveGb = None,
    largest_recording: LargestRecording = LARGEST_RECORDING,
    launched: Launched = False,
    listener: Annotated[
        int | None, typer.Option("--listener", hidden=True, help="The descriptor of a socket that listens already.")
    ] = None,
) -> None:
    """Run the server alone; `run` does this."""
    from sequence_planner.server.server import serve  # noqa: PLC0415

    begin(launched, socket.parent)
    os.nice(_NICENESS)
    provider = _provider(
        ProviderOptions(
            issuer=oidc_issuer,
            client=oidc_client,
            secret_file=oidc_client_secret_file,
            title=oidc_title,
            scopes=tuple(oidc_scope or ()),
            groups=oidc_groups_claim,
            roles=tuple(oidc_role or ()),
            others=oidc_others,
        )
    )
    os.environ.pop(CLIENT_SECRET, None)  # nothing that is started from here needs it
    settings = Settings(
        controller_socket=socket,
        page=page,
        database=database_url(model, database),
        host=host,
        port=port,
        certificate=certificate,
        private_key=private_key,
        proxies=tuple(proxy or ()),
        names=tuple(name or ()),
        wall_beside=tuple(wall_beside or ()),
        model=model,
        transport=transport,
        demonstration=demonstration,
        start=StartNeeds(emulated, rosbridge is not None),
        provider=provider,
        webhooks=_targets(webhook_host, webhook_network, webhook_loopback),
        backups=Keeping(backup_folder, backups_kept, backup_every),
        retention=Retention.from_options(
            journal_days, journal_gb, order_days, archive_folder, archive_days, archive_gb
        ),
        largest_recording=largest_recording,
    )
    listening = None if listener is None else ListeningSocket(fileno=listener)
    serve(settings, listening)


def _provider(options: ProviderOptions) -> ProviderSettings | None:
    """The provider that is named, if one is; what cannot be used is refused."""
    try:
        return options.settings(os.environ)
    except ProviderOptionError as error:
        refuse(str(error))


def _targets(hosts: list[str] | None, networks: list[str] | None, loopback: bool) -> Targets:
    targets, wrong = webhook_targets(hosts or (), networks or (), loopback)
    for each in wrong:
        refuse(each)
    return targets
