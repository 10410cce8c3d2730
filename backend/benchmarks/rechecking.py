"""What `check` of the truck engine station takes after an edit, as a whole process, beside what it takes from nothing.

Run with `make bench`. What the answers before the edit rest on is kept, as it is for whoever edits a station. Times are
of a processor, with all processes. With `--compare` each edit is checked from nothing, too, which takes minutes: both
must find the same.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

STATION = Path(__file__).parents[2] / "models" / "truck_engine_station"
PROGRAM = Path(sys.executable).with_name("sequence-planner")
DEADLINE = 1800  # seconds on the wall, of a machine that has other work as well
DOCKED = "position in docked implies end_effector.tool in {none, tool_at[position]}"
BOLTS = "position in bolt_pair implies end_effector.tool == ATLASTOOL"
EDITS = {
    "a comment": ("title: Robot UR10\n", "title: Robot UR10 # it stands beside the dock\n"),
    "a guard loosened": (DOCKED, f"{DOCKED} or position == AttachAtlasTCPPose and end_effector.tool == OFTOOL"),
    "a guard tightened": (BOLTS, f"{BOLTS} and end_effector.rsp_is_locked"),
    "a guard tightened so that a goal needs another way": (
        "(position == AttachLFToolTCPPose implies ladder_frame != in_gripper)",
        "(position == AttachLFToolTCPPose implies ladder_frame != in_gripper) and "
        "(position == HomeJOINTPose implies ladder_frame != in_gripper)",
    ),
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--compare", action="store_true")
    compare = parser.parse_args().compare
    with tempfile.TemporaryDirectory() as folder:
        kept = Path(folder) / "kept"
        took, _ = checked(STATION, kept)
        print(f"from nothing {took:.1f} s", flush=True)
        for number, (name, (was, text)) in enumerate(EDITS.items()):
            edited = shutil.copytree(STATION, Path(folder) / f"edit_{number}" / STATION.name)
            file = edited / "resources" / "robot.yaml"
            written = file.read_text(encoding="utf-8")
            if was not in written:
                raise RuntimeError(f"{file} has no `{was}` any more: edit something else")
            file.write_text(written.replace(was, text, 1), encoding="utf-8")
            again, found = checked(edited, Path(shutil.copytree(kept, Path(folder) / f"kept_{number}")))
            print(f"{name} {again:.1f} s", flush=True)
            if compare:
                anew, expected = checked(edited, Path(folder) / f"anew_{number}")
                if found != expected:
                    raise RuntimeError(f"after {name}, from what was kept:\n{found}\nfrom nothing:\n{expected}")
                print(f"  from nothing {anew:.1f} s", flush=True)


def checked(station: Path, cache: Path) -> tuple[float, str]:
    """Seconds of a processor, and what was found."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(
        [PROGRAM, "check", "--deadline", str(DEADLINE), str(station)],
        env={**os.environ, "XDG_CACHE_HOME": str(cache)},
        capture_output=True,
        text=True,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, run.stdout + run.stderr


if __name__ == "__main__":
    main()
