"""`security`: the policy of SROS 2 for a station, and how its keys are made."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import StationFolder, refuse
from sequence_planner.cli.part_options import prepare


def security(
    model: StationFolder,
    to: Annotated[Path, typer.Option(metavar="FILE", help="The file to write the policy to, in XML.")],
    keystore: Annotated[
        Path, typer.Option(metavar="FOLDER", help="Where the keys are to be, in what is printed.")
    ] = Path("keystore"),
) -> None:
    """Write what each node of a station may do on a secured ROS 2 network, as a policy of SROS 2.

    What is printed makes the keys, on a machine with ROS 2.
    """
    from sequence_planner.export.sros2 import enclaves, policy  # noqa: PLC0415

    station = prepare(model)
    try:
        to.write_text(policy(station.pipelines, station.ros_1), encoding="utf-8")
    except OSError as error:
        refuse(f"{to} cannot be written: {error.strerror}")
    typer.echo(f"ros2 security create_keystore {keystore}")
    for path in enclaves(station.pipelines, station.ros_1):
        typer.echo(f"ros2 security create_enclave {keystore} {path}")
        typer.echo(f"ros2 security create_permission {keystore} {path} {to}")
