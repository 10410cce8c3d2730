"""Emulated devices as a person uses them: a process, faults from a file and from the command line, over real DDS."""

from __future__ import annotations

from pathlib import Path

from support.station import MODEL, finished, process
from support.waiting import until

BEGINS = "robot silent for 5 s"


def test_devices_run_alone_have_faults_and_answer(tmp_path: Path) -> None:
    script, log = tmp_path / "faults.yaml", tmp_path / "emulate.log"
    script.write_text(f"faults:\n  - {{at: 0.1, fault: {BEGINS}}}\n")
    options = ("--resource", "robot", "--jitter", "0.1", "--seed", "7", "--faults", str(script))
    with process(log, "emulate", str(MODEL), *options):
        until(lambda: f"fault='{BEGINS}'" in log.read_text())
        begun = finished("fault", "robot slow 2")
        assert (begun.returncode, begun.stdout) == (0, "begins\n")
        ended = finished("fault", "clear robot")
        assert ended.returncode == 0
        assert "robot slow 2" in ended.stdout
        refused = finished("fault", "nutrunner silent")
        assert (refused.returncode, refused.stdout) == (1, "")
        assert "no emulated device has `nutrunner`" in refused.stderr
        moved = finished("by-hand", "robot.moving := true")
        assert (moved.returncode, moved.stdout) == (0, "done\n")
        refused = finished("by-hand", "robot.pose := nowhere")
        assert (refused.returncode, refused.stdout) == (1, "")
        assert "`nowhere` is no value of robot.pose" in refused.stderr
    alone = finished("fault", "clear")
    assert alone.returncode == 2
    assert "no emulated devices are running" in alone.stderr


def test_what_cannot_be_emulated_is_refused_at_once(tmp_path: Path) -> None:
    script = tmp_path / "faults.yaml"
    script.write_text("faults:\n  - {at: 1, fault: robot sillent}\n")
    refused = finished("emulate", str(MODEL), "--faults", str(script))
    assert refused.returncode == 2
    assert f"{script}:2:26: `sillent` is no fault" in refused.stderr
    unknown = finished("emulate", str(MODEL), "--resource", "robbot")
    assert unknown.returncode == 2
    assert "`robbot` has no devices here; did you mean `robot`?" in unknown.stderr
