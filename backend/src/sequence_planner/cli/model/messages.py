"""A station's own message definitions, written for ROS 2."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import StationFolder, refuse
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.builder import load_messages
from sequence_planner.ros.types.interfaces import write_ament_package


def messages(
    model: StationFolder,
    ament: Annotated[Path, typer.Option(help="Folder to write the ROS 2 packages of its messages to.")],
) -> None:
    """Write the station's message definitions as packages that colcon builds, for ROS 2 with rclpy."""
    try:
        station = load_station(model)
        load_messages(station)
    except ModelError as error:
        refuse(str(error))
    try:
        for folder in station.message_folders or [station.messages]:
            for package in write_ament_package(folder, ament):
                typer.echo(package)
    except OSError as error:
        refuse(f"{ament} cannot be written to: {error.strerror}")
