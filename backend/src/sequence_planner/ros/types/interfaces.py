"""A colcon package of a station's messages.

rclpy wants generated code for every message type, even to carry raw bytes. ROS 2 generates it when colcon builds a
package with the `.msg`, `.srv` and `.action` files and two files that say so; this module writes them from the
station's `messages` folder.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from sequence_planner.ros.types.definitions import Interface, field_type, read_interfaces
from sequence_planner.ros.types.messages import MessageRegistry

_PACKAGE_XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.1.0</version>
  {mark}
  <maintainer email="nobody@example.com">station</maintainer>
  <license>Proprietary</license>

  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
{depends}  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>

  <export><build_type>ament_cmake</build_type></export>
</package>
"""

#: What tells a folder that this module wrote from one that somebody else did.
_MARK = "<description>Messages of a Sequence Planner station</description>"

_CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project({package})

find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
{finds}
rosidl_generate_interfaces(${{PROJECT_NAME}}
{messages}{dependencies})

ament_export_dependencies(rosidl_default_runtime)
ament_package()
"""


def write_ament_package(messages_dir: Path, destination: Path) -> list[Path]:
    """Write one ament_cmake package below `destination` for each package of `messages_dir`, and return their folders.

    `destination` is best a colcon workspace's `src`. Packages written earlier are replaced; a folder that holds
    anything else is left alone, with FileExistsError. Raises MessageDefinitionError for definitions that cannot be
    used. Either way nothing has been written then.
    """
    MessageRegistry.from_folder(messages_dir)
    packages: dict[str, list[Interface]] = {}
    for interface in read_interfaces(messages_dir):
        packages.setdefault(interface.type_name.split("/")[0], []).append(interface)
    for package in packages:
        _check_replaceable(destination / package)
    return [_write(destination / package, package, interfaces) for package, interfaces in packages.items()]


def _check_replaceable(folder: Path) -> None:
    manifest = folder / "package.xml"
    ours = manifest.is_file() and _MARK in manifest.read_text(encoding="utf-8")
    if folder.exists() and not ours:
        raise FileExistsError(f"{folder} is there already and was not written here: choose another destination")


def _write(folder: Path, package: str, interfaces: list[Interface]) -> Path:
    dependencies = sorted(_used(interfaces) - {package})
    if folder.exists():
        shutil.rmtree(folder)
    files = [f"{interface.kind}/{interface.path.name}" for interface in interfaces]
    for interface, file in zip(interfaces, files, strict=True):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(interface.path, folder / file)
    depends = "".join(f"  <depend>{name}</depend>\n" for name in dependencies)
    (folder / "package.xml").write_text(
        _PACKAGE_XML.format(package=package, mark=_MARK, depends=depends), encoding="utf-8"
    )
    (folder / "CMakeLists.txt").write_text(
        _CMAKE.format(
            package=package,
            finds="".join(f"find_package({name} REQUIRED)\n" for name in dependencies),
            messages="".join(f'  "{file}"\n' for file in files),
            dependencies=f"  DEPENDENCIES {' '.join(dependencies)}\n" if dependencies else "",
        ),
        encoding="utf-8",
    )
    return folder


def _used(interfaces: list[Interface]) -> set[str]:
    """Return the packages whose messages are used, and what rosidl wants beside them for an action."""
    used = {
        field_type(field.description).type_name.split("/")[0]
        for interface in interfaces
        for message in interface.messages
        for field in message.fields
        if field_type(field.description).kind == "message"
    }
    return used | {"action_msgs"} if any(interface.kind == "action" for interface in interfaces) else used
