"""The settings that `run` is told, where not on the command line: in a file (TOML), or in the environment.

The command line comes before the environment, and that before the file. What is told nowhere is as the command says. A
name that nobody knows is refused, as is a value that does not fit, with where it stands: else a mistake in a file would
be a station that runs otherwise than it was meant to.
"""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from pydantic import Field, ValidationError

from sequence_planner.core.data_models import DataModel, complained
from sequence_planner.core.logging import FORMAT, LogFormat
from sequence_planner.core.secrets import CLIENT_SECRET
from sequence_planner.db.location import read_url
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.process.memory_limit import LEAST, MOST
from sequence_planner.retention.settings import LEAST_ORDER_DAYS, MOST_DAYS, MOST_GB, NO_ARCHIVE
from sequence_planner.ros.environment import INTERFACE
from sequence_planner.ros.transports.choice import TransportChoice

PREFIX: Final = "SEQUENCE_PLANNER_"
FILE: Final = f"{PREFIX}CONFIGURATION"  # the variable that names the file
_ELSEWHERE: Final = {INTERFACE, FORMAT, FILE, CLIENT_SECRET}  # variables that others read
_LISTS: Final = ("proxy", "name", "wall_beside", "oidc_scope", "oidc_role", "webhook_host", "webhook_network")
_PATHS: Final = (
    "model",
    "certificate",
    "private_key",
    "database_file",
    "oidc_client_secret_file",
    "backup_folder",
    "archive_folder",
)  # from the file's folder, where they are relative
_SECRET: Final = "database"
_OPTION: Final = re.compile(r"(?<![\w-])--([a-z]+(?:-[a-z]+)*)(?![\w-])")


class Configuration(DataModel):
    """All that there is to say, by the names of the options with `_` for `-`. What is null is not said."""

    model: Path | None = None
    host: str | None = None
    port: Annotated[int, Field(ge=1, le=65535)] | None = None
    certificate: Path | None = None
    private_key: Path | None = None
    proxy: list[str] | None = None
    name: list[str] | None = None
    wall_beside: list[str] | None = None
    database: str | None = None
    database_file: Path | None = None
    transport: TransportChoice | None = None
    rosbridge: str | None = None
    emulator: bool | None = None
    start: bool | None = None
    emulator_speed: Annotated[float, Field(ge=0.1, le=100)] | None = None
    demonstration: bool | None = None
    hot_standby: str | None = None
    oidc_issuer: str | None = None
    oidc_client: str | None = None
    oidc_client_secret_file: Path | None = None
    oidc_title: str | None = None
    oidc_scope: list[str] | None = None
    oidc_groups_claim: str | None = None
    oidc_role: list[str] | None = None
    oidc_others: str | None = None
    webhook_host: list[str] | None = None
    webhook_network: list[str] | None = None
    webhook_loopback: bool | None = None
    backup_folder: Path | None = None
    backups_kept: Annotated[int, Field(ge=1, le=1000)] | None = None
    backup_every: Annotated[float, Field(ge=0.25, le=8760)] | None = None
    journal_days: Annotated[float, Field(ge=0.01, le=MOST_DAYS)] | None = None
    journal_gb: Annotated[float, Field(ge=0.001, le=MOST_GB)] | None = None
    order_days: Annotated[float, Field(ge=LEAST_ORDER_DAYS, le=MOST_DAYS)] | None = None
    archive_folder: str | None = None
    archive_days: Annotated[float, Field(ge=1, le=MOST_DAYS)] | None = None
    archive_gb: Annotated[float, Field(ge=0.001, le=MOST_GB)] | None = None
    largest_recording: Annotated[int, Field(ge=1, le=100_000)] | None = None
    log_format: LogFormat | None = None
    memory: Annotated[float, Field(ge=LEAST, le=MOST)] | None = None


class ConfigurationError(Exception):
    """It cannot be used: a line for each mistake, with where it stands and what to do. No value is quoted."""


@dataclass(frozen=True)
class ConfiguredSetting:
    """A setting, its value as a command line would have it, and where it was told: a file's line, or a variable."""

    name: str
    value: str | bool | int | float | list[str]
    where: str

    @property
    def shown(self) -> str:
        """Its value for people: without the password that a URL may hold."""
        if self.name != _SECRET:
            return json.dumps(self.value, ensure_ascii=False)
        from sqlalchemy.exc import ArgumentError  # noqa: PLC0415 - few stations are told of a database here

        try:
            return json.dumps(read_url(str(self.value)).render_as_string(hide_password=True))
        except (ArgumentError, ValueError):
            return '"(cannot be read)"'

    @property
    def called(self) -> str:
        """The name by which whoever told it calls it."""
        return self.where if self.where.startswith(PREFIX) else f"`{self.name}` ({self.where})"


def configured(file: Path | None, environ: Mapping[str, str] = os.environ) -> dict[str, ConfiguredSetting]:
    """All that is told, by name; the environment before the file. Raises `ConfigurationError`."""
    found, wrong = read_configuration(file, environ)
    if wrong:
        raise ConfigurationError("\n".join(wrong))
    return found


def read_configuration(file: Path | None, environ: Mapping[str, str]) -> tuple[dict[str, ConfiguredSetting], list[str]]:
    """Return what is told so that it can be used, by name, and what is wrong. Raises `ConfigurationError` without a
    file.
    """
    found, wrong = dict[str, ConfiguredSetting](), list[str]()
    for source in (_in_file(file) if file is not None else (), _in_environment(environ)):
        for each in source:
            if isinstance(each, ConfiguredSetting):
                found[each.name] = each
            else:
                wrong.append(each)
    return found, wrong


def options_in(text: str) -> list[str]:
    """The settings that are named as options in `text`, such as `--private-key`."""
    found = (each[1].replace("-", "_") for each in _OPTION.finditer(text))
    return [name for name in found if name in Configuration.model_fields]


def as_told(text: str, called: Mapping[str, str]) -> str:
    """`text` in which each option is called what it was told as, where `called` says so."""
    return _OPTION.sub(lambda each: called.get(each[1].replace("-", "_"), each[0]), text)


def has_password(url: str) -> bool:
    """Return whether a URL of a database holds one; one that cannot be read is for others to refuse."""
    from sqlalchemy.exc import ArgumentError  # noqa: PLC0415 - as above

    try:
        return read_url(url).password is not None
    except (ArgumentError, ValueError):
        return False


def url_in(file: Path) -> str:
    """The URL of a database that a file holds, as secrets are given to services. Raises `ConfigurationError`."""
    text = _read(file).strip()
    if not text or "\n" in text:
        raise ConfigurationError(f"{file}: write the database's URL there, in one line and nothing else")
    return text


def _in_file(file: Path) -> Iterator[ConfiguredSetting | str]:
    """Yield what a file tells, and what is wrong in it."""
    text = _read(file)
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        yield f"{file}: this is no TOML: {error}"
        return
    lines = {name: f"{file}:{_line(text, name)}" for name in document}
    wrong = sorted(_wrong(document, strict=True), key=lambda each: _line(text, each[0]))
    yield from (f"{lines[name]}: {why}" for name, why in wrong)
    if _SECRET in document and has_password(str(document[_SECRET])) and stat.S_IMODE(file.stat().st_mode) & 0o077:
        yield f"{lines[_SECRET]}: others may read this file, and there is a password in it: chmod 600 {file}"
    for name, value in document.items():
        if name in Configuration.model_fields and name not in dict(wrong):
            yield ConfiguredSetting(name, _path(file, name, value), lines[name])


def _path(file: Path, name: str, value: str | bool | int | float | list[str]) -> str | bool | int | float | list[str]:
    """A value as the command line would have it: a path is relative to the file that names it."""
    is_path = name in _PATHS and isinstance(value, str) and (name, value) != ("archive_folder", NO_ARCHIVE)
    return str(file.parent / str(value)) if is_path else value


def _in_environment(environ: Mapping[str, str]) -> Iterator[ConfiguredSetting | str]:
    """Yield what the environment tells, and what is wrong in it. A variable that is empty tells nothing."""
    variables = {f"{PREFIX}{name.upper()}": name for name in Configuration.model_fields}
    document: dict[str, str | list[str]] = {}
    for variable, value in environ.items():
        if not variable.startswith(PREFIX) or variable in _ELSEWHERE - {FORMAT} or not value:
            continue
        if (name := variables.get(variable)) is None:
            yield f"{variable}: there is no such variable{suggestion(variable, variables)} Unset it."
            continue
        document[name] = value.split() if name in _LISTS else value
    wrong = dict(_wrong(document, strict=False))
    for name, told in document.items():
        variable = f"{PREFIX}{name.upper()}"
        yield f"{variable}: {wrong[name]}" if name in wrong else ConfiguredSetting(name, told, variable)


def _wrong(document: Mapping[str, object], strict: bool) -> Iterator[tuple[str, str]]:
    """The settings with something wrong, and what that is. In a file types count, as in `port = 8000`."""
    try:
        Configuration.model_validate_json(json.dumps(document, default=str), strict=strict)
    except ValidationError as error:
        for each in error.errors(include_input=False, include_url=False):
            name = str(each["loc"][0])
            if each["type"] == "extra_forbidden":
                yield name, f"there is no setting `{name}`{suggestion(name, Configuration.model_fields)}"
            else:
                yield name, f"`{name}` is not as it must be: {complained(each)}"


def _line(text: str, name: str) -> int:
    """The number of the line where a setting stands; 1 where that cannot be seen."""
    assigned = re.compile(rf"""\s*(\[+\s*)?["']?{re.escape(name)}["']?\s*[=.\]]""")
    return next((number for number, line in enumerate(text.split("\n"), 1) if assigned.match(line)), 1)


def _read(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigurationError(f"{file} cannot be read: {error.strerror}") from error
    except UnicodeDecodeError:
        raise ConfigurationError(f"{file} is no text in UTF-8") from None
