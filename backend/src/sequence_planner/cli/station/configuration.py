"""`configuration`: show the effective settings of `run`, and check their validity and consistency."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.auth.oidc.options import ProviderOptionError, ProviderOptions
from sequence_planner.auth.oidc.settings import NO_OTHERS
from sequence_planner.cli.loading import load_model
from sequence_planner.cli.options import AsJson, print_json, refuse
from sequence_planner.cli.station.option_conflicts import webhook_targets, wrong_together
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile, address
from sequence_planner.model.source import ModelError
from sequence_planner.model.stages.sandbox.confinement import missing
from sequence_planner.retention.settings import NO_ARCHIVE
from sequence_planner.server.binding import check_demonstration, wrong_with
from sequence_planner.server.settings import Endpoint, SettingsError
from sequence_planner.settings import (
    FILE,
    Configuration,
    ConfigurationError,
    ConfiguredSetting,
    as_told,
    configured,
    options_in,
    read_configuration,
    url_in,
)

# Whether what a configuration says can be used: what it names is there and fit, and nothing contradicts the rest.

_READ_WHOLE = ("oidc_client_secret_file",)


def unfit(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    """Yield what `run` would not start with, each with where it was told. Nothing is made, written or upgraded."""
    for check in (_model, _endpoint, _together, _provider, _webhooks, _database, _secrets, _folders):
        yield from check(told)


def _model(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    if (model := told.get("model")) is not None:
        try:
            load_model(Path(str(model.value)))
        except ModelError as error:
            yield from (f"{model.where}: {finding}" for finding in error.findings)


def _endpoint(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    """Check where it listens, by which names, and with what certificate."""
    given = {name: each.value for name, each in told.items()}
    endpoint = Endpoint(
        host=str(given.get("host", Endpoint.host)),
        port=int(str(given.get("port", Endpoint.port))),
        certificate=_path(given.get("certificate")),
        private_key=_path(given.get("private_key")),
        proxies=_list(given.get("proxy")),
        names=_list(given.get("name")),
        wall_beside=_list(given.get("wall_beside")),
    )
    yield from _placed(told, wrong_with(endpoint))
    if given.get("demonstration"):
        try:
            check_demonstration(endpoint)
        except SettingsError as error:
            yield from _placed(told, [str(error)])


def _together(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    """Yield what of it contradicts something else of it."""
    given = {name: each.value for name, each in told.items()}
    standby = given.get("hot_standby")
    yield from _placed(
        told,
        wrong_together(
            emulator=bool(given.get("emulator")),
            start=bool(given.get("start")),
            demonstration=bool(given.get("demonstration")),
            database="database" in told,
            database_file="database_file" in told,
            hot_standby=None if standby is None else str(standby),
            provider="oidc_issuer" in told,
        ),
    )


def _provider(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    given = {name: each.value for name, each in told.items()}
    options = ProviderOptions(
        issuer=_text(given.get("oidc_issuer")),
        client=_text(given.get("oidc_client")),
        title=_text(given.get("oidc_title")),
        scopes=_list(given.get("oidc_scope")),
        roles=_list(given.get("oidc_role")),
        others=str(given.get("oidc_others", NO_OTHERS)),
    )
    try:
        options.settings({})
    except ProviderOptionError as error:
        about = [name for name in told if name.startswith("oidc_")]
        yield from _placed(told, [str(error)], about)


def _webhooks(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    given = {name: each.value for name, each in told.items()}
    _, wrong = webhook_targets(_list(given.get("webhook_host")), _list(given.get("webhook_network")), loopback=False)
    yield from _placed(told, wrong)


def _placed(
    told: Mapping[str, ConfiguredSetting], complaints: Iterable[str], about: Sequence[str] = ()
) -> Iterator[str]:
    """Complaints about options, each where the first of these was told, or else the first that it is `about`."""
    called = {name: f"`{name}`" for name in Configuration.model_fields}
    anywhere = next(iter(told.values())).where.rpartition(":")[0] if told else ""
    for each in complaints:
        where = next((told[name].where for name in (*options_in(each), *about) if name in told), anywhere)
        yield f"{where}: {as_told(each, called)}"


def _text(value: object) -> str | None:
    return None if value is None else str(value)


def _path(value: object) -> Path | None:
    return None if value is None else Path(str(value))


def _list(value: object) -> tuple[str, ...]:
    return tuple(map(str, value)) if isinstance(value, list) else ()


def _database(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    try:
        if (file := told.get("database_file")) is not None:
            where, url = file.where, url_in(Path(str(file.value)))
        elif (named := told.get("database")) is not None:
            where, url = named.where, str(named.value)
        else:
            return
        place = address(url)
        if "hot_standby" in told and isinstance(place, SqliteFile):
            yield f"{told['hot_standby'].where}: several stations cannot share {place}: `hot_standby` takes PostgreSQL"
        if isinstance(place, SqliteFile) and not place.path.exists():
            if (why := _unusable_folder(place.path.parent)) is not None:
                yield f"{where}: {place.path} cannot be made: {why}"
            return
        with closing(Database.open(url, create=False)):
            pass
    except ConfigurationError as error:
        yield f"{told['database_file'].where}: {error}"
    except StorageError as error:
        yield f"{where}: {error}"


def _secrets(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    for name in _READ_WHOLE:
        if (file := told.get(name)) is not None:
            try:
                if not Path(str(file.value)).read_text(encoding="utf-8").strip():
                    yield f"{file.where}: {file.value} is empty: write the secret there"
            except OSError as error:
                yield f"{file.where}: {file.value} cannot be read: {error.strerror}"
            except UnicodeDecodeError:
                yield f"{file.where}: {file.value} is no text in UTF-8"


def _folders(told: Mapping[str, ConfiguredSetting]) -> Iterator[str]:
    for name, what in (("backup_folder", "backups"), ("archive_folder", "the archive")):
        folder = told.get(name)
        if folder is None or (name, folder.value) == ("archive_folder", NO_ARCHIVE):
            continue
        why = _unusable_folder(Path(str(folder.value)))
        if why is not None:
            yield f"{folder.where}: {folder.value} cannot hold {what}: {why}"


def _unusable_folder(folder: Path) -> str | None:
    """Say why nothing can be written in a folder; None where it can."""
    if not folder.is_dir():
        return f"there is no folder {folder}"
    return None if os.access(folder, os.W_OK | os.X_OK) else f"this user may not write in {folder}"


# `configuration`: what `run` would be told by a file and the environment, without running anything.

configuration = typer.Typer(
    name="configuration",
    no_args_is_help=True,
    add_completion=False,
    help="Look at what `run` is told by a configuration file and by the environment.",
)
File = Annotated[Path | None, typer.Argument(metavar="[FILE]", envvar=FILE, help="The file.", show_default=False)]


@configuration.command()
def check(file: Annotated[Path, typer.Argument(metavar="FILE", help="The file.")]) -> None:
    """Say what is wrong in a file, with file and line, and whether what it names is there and fit: the model,
    certificates, secrets, the database. The environment is not looked at, and nothing is changed.
    """
    try:
        told, wrong = read_configuration(file, {})
    except ConfigurationError as error:
        refuse(str(error))
    if wrong := [*wrong, *unfit(told)]:
        refuse("\n".join(wrong))
    typer.echo(f"{file} can be used: {', '.join(told) or 'it tells nothing'}")
    if without := missing():
        typer.echo(f"This system cannot keep Python stages from {' and '.join(without)}: see docs/deployment.md.")


@configuration.command()
def show(file: File = None, as_json: AsJson = False) -> None:
    """Print what is told, and where: by the file, and by variables, which come before it. Passwords are left out."""
    try:
        told = configured(file)
    except ConfigurationError as error:
        refuse(str(error))
    if as_json:
        print_json({name: {"value": each.shown, "where": each.where} for name, each in told.items()})
        return
    for name, each in told.items():
        typer.echo(f"{name} = {each.shown}  # {each.where}")
