"""Whether what a configuration names is there and fit: the model, certificates, secrets, the database, folders."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import closing
from pathlib import Path

from sequence_planner.cli.loading import load_model
from sequence_planner.configuration import ConfigurationError, Told, url_in
from sequence_planner.model.source import ModelError
from sequence_planner.retention.settings import NO_ARCHIVE
from sequence_planner.storage.address import SqliteFile, address
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.web.certificate import check_certificate
from sequence_planner.web.settings import SettingsError, split_name

_READ_WHOLE = ("oidc_client_secret_file",)


def unfit(told: Mapping[str, Told]) -> Iterator[str]:
    """What `run` would not start with, each with where it was told. Nothing is made, written or upgraded."""
    for check in (_model, _certificate, _database, _secrets, _folders):
        yield from check(told)


def _model(told: Mapping[str, Told]) -> Iterator[str]:
    if (model := told.get("model")) is not None:
        try:
            load_model(Path(str(model.value)))
        except ModelError as error:
            yield from (f"{model.where}: {finding}" for finding in error.findings)


def _certificate(told: Mapping[str, Told]) -> Iterator[str]:
    certificate, key = told.get("certificate"), told.get("private_key")
    if certificate is None and key is None:
        return
    if certificate is None or key is None:
        there, missing = (certificate or key), "private_key" if key is None else "certificate"
        assert there is not None
        yield f"{there.where}: `{missing}` is missing beside it: HTTPS needs both"
        return
    names = told["name"].value if "name" in told else []
    try:
        hosts = [split_name(str(name))[0] for name in (names if isinstance(names, list) else [names])]
        check_certificate(Path(str(certificate.value)), Path(str(key.value)), hosts)
    except SettingsError as error:
        yield f"{certificate.where}: {error}"


def _database(told: Mapping[str, Told]) -> Iterator[str]:
    try:
        if (file := told.get("database_file")) is not None:
            where, url = file.where, url_in(Path(str(file.value)))
        elif (named := told.get("database")) is not None:
            where, url = named.where, str(named.value)
        else:
            return
        place = address(url)
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


def _secrets(told: Mapping[str, Told]) -> Iterator[str]:
    for name in _READ_WHOLE:
        if (file := told.get(name)) is not None:
            try:
                if not Path(str(file.value)).read_text(encoding="utf-8").strip():
                    yield f"{file.where}: {file.value} is empty: write the secret there"
            except OSError as error:
                yield f"{file.where}: {file.value} cannot be read: {error.strerror}"
            except UnicodeDecodeError:
                yield f"{file.where}: {file.value} is no text in UTF-8"


def _folders(told: Mapping[str, Told]) -> Iterator[str]:
    for name, what in (("backup_folder", "backups"), ("archive_folder", "the archive")):
        folder = told.get(name)
        if folder is None or (name, folder.value) == ("archive_folder", NO_ARCHIVE):
            continue
        why = _unusable_folder(Path(str(folder.value)))
        if why is not None:
            yield f"{folder.where}: {folder.value} cannot hold {what}: {why}"


def _unusable_folder(folder: Path) -> str | None:
    """Why nothing can be written in a folder; None where it can."""
    if not folder.is_dir():
        return f"there is no folder {folder}"
    return None if os.access(folder, os.W_OK | os.X_OK) else f"this user may not write in {folder}"
