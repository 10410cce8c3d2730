"""`packages`: packages of types of resources, brought into a station's folder and locked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import FINDINGS, AsJson, StationFolder, print_json, refuse
from sequence_planner.model.documents import StationDocument
from sequence_planner.model.source import ModelError
from sequence_planner.model.types.fetching import Brought, bring_packages
from sequence_planner.model.types.packages import PackageError, UsedPackages, read_lock, source_of
from sequence_planner.model.yaml.reader import read_yaml

packages = typer.Typer(
    name="packages",
    add_completion=False,
    no_args_is_help=True,
    help="Packages of types of resources: bring them, and see what is here.",
)
Names = Annotated[list[str] | None, typer.Argument(metavar="NAME", help="The packages; without it all.")]


@packages.command()
def fetch(model: StationFolder, json: AsJson = False) -> None:
    """Bring the packages that station.yaml names, as packages.lock has them; what is not locked yet is locked."""
    _bring(model, [], json)


@packages.command()
def update(model: StationFolder, names: Names = None, json: AsJson = False) -> None:
    """Bring packages as their sources have them now, and lock them so."""
    station = _station(model)
    for name in names or ():
        if name not in station.packages:
            refuse(f"station.yaml names no package `{name}`: it has {', '.join(station.packages) or 'none'}")
    _bring(model, names or list(map(str, station.packages)), json)


@packages.command("list")
def list_packages(model: StationFolder, json: AsJson = False) -> None:
    """Show the packages of a station: version, source, and the commit that is locked."""
    station = _station(model)
    try:
        locked = read_lock(model)
    except ModelError as error:
        refuse(str(error))
    found = [
        {
            "name": str(name),
            "source": source_of(source),
            "version": str(locked[name].version) if name in locked else None,
            "revision": str(locked[name].revision) if name in locked and locked[name].revision else None,
            "hash": locked[name].hash if name in locked else None,
        }
        for name, source in station.packages.items()
    ]
    if json:
        print_json(found)
        return
    for each in found:
        typer.echo(f"{each['name']} {each['version'] or 'not locked'} {each['revision'] or ''} {each['source']}")


@packages.command()
def verify(model: StationFolder, json: AsJson = False) -> None:
    """Say whether the packages here are what packages.lock has the hashes of; nothing is asked of a network."""
    used = UsedPackages(model, _station(model))
    if json:
        print_json({"packages": sorted(used.packages), "findings": [str(each) for each in used.findings]})
    else:
        for name, package in used.packages.items():
            typer.echo(f"{name} {package.version} is what is locked")
        for finding in used.findings:
            typer.echo(str(finding), err=True)
    if used.findings:
        raise typer.Exit(FINDINGS)


def _bring(model: Path, names: list[str], json: bool) -> None:
    try:
        brought = bring_packages(model, _station(model), names)
    except (ModelError, PackageError) as error:
        refuse(str(error))
    except OSError as error:
        refuse(f"the packages of {model} cannot be brought: {error.strerror}: {error.filename}")
    if json:
        print_json([each._asdict() for each in brought])
        return
    for each in brought:
        typer.echo(_told(each))


def _told(each: Brought) -> str:
    revision = f" at {each.revision}" if each.revision else ""
    return f"{each.name} {each.version}{revision}: {'locked' if each.is_new else 'as it is locked'}"


def _station(model: Path) -> StationDocument:
    """What station.yaml says of packages, whatever else is wrong in it."""
    try:
        document = read_yaml(model / "station.yaml", str(model / "station.yaml"))
    except ModelError as error:
        refuse(str(error))
    from sequence_planner.model.reading.folder import station_packages  # noqa: PLC0415

    try:
        return station_packages(document)
    except ModelError as error:
        refuse(str(error))
