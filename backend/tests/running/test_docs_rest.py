"""What `docs/rest.md` types is typed, at a station that nobody has signed in at yet, and does what the page says."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from running.workshops import EditedStation
from server.test_docs_curl import typed
from support.network import free_port
from support.places import REPOSITORY
from support.station import command, environment, process, signed_in
from support.waiting import until

PAGE = REPOSITORY / "docs" / "rest.md"

pytestmark = pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl here")


def walk(model: Path, port: int) -> tuple[list[str], str]:
    """The arguments of the command that runs the station, and all that is typed beside it."""
    begin, *rest = re.findall(r"^```sh\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    copied, run = begin.splitlines()
    assert shlex.split(copied) == ["cp", "-r", "models/bolt_tightening", "my_station"]
    executable, *arguments = shlex.split(run)
    lines = "".join(rest).replace("http://127.0.0.1:8000", f"http://127.0.0.1:{port}")
    lines = lines.replace(executable, shlex.join(command())).replace("my_station", shlex.quote(str(model)))
    return [str(model) if each == "my_station" else each for each in arguments], lines


def test_what_the_page_types_leads_from_the_first_administrator_to_a_stop(tmp_path: Path) -> None:
    model, port, log = tmp_path / "my_station", free_port(), tmp_path / "station.log"
    shutil.copytree(REPOSITORY / "models" / "bolt_tightening", model)
    arguments, lines = walk(model, port)
    with process(log, *arguments, "--port", str(port)) as running:
        until(lambda: "runs: open" in log.read_text(), seconds=150)
        printed = typed(lines, tmp_path, 300, **environment())
        station = EditedStation(running, port, log, model)
        station.__dict__["browser"] = signed_in(model, port)
        seen = station.station()
    assert '"name":"Erik","role":"engineer"' in printed
    assert '"must_change_password":true' in printed
    assert '{"legal":true,' in printed
    assert '"id":"4711"' in printed
    assert "\npaused\n" in printed
    assert (seen["station"]["title"], seen["mode"], seen["by_order"], seen["production"]) == (
        "Our bolts",
        "hold",
        True,
        "started",
    )
    assert "\ntitle: {en: Our bolts, " in (model / "station.yaml").read_text(encoding="utf-8")
