"""`journal replay` and `journal show`, as people use them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from history.journalled import worked
from support.commands import command
from support.places import BOLT_TIGHTENING


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The station with an operation's title changed."""
    folder = tmp_path_factory.mktemp("changed") / "station"
    shutil.copytree(BOLT_TIGHTENING, folder)
    file = folder / "station.yaml"
    file.write_text(file.read_text().replace("title: {en: ", "title: {en: Another ", 1))
    return folder


def test_the_run_is_replayed_and_looked_at(changed: Path) -> None:
    with worked(6.0) as (database, execution):
        url = f"sqlite:///{database.place}"
        code, out, err = command("journal", "replay", BOLT_TIGHTENING, "--database", url)
        assert (code, err) == (0, "")
        assert out.startswith("replayed up to record ")
        assert out.endswith(": every state is as it was\n")
        last = int(out.split()[4].rstrip(":"))
        code, out, _ = command("journal", "replay", BOLT_TIGHTENING, "--database", url, "--from", 3, "--to", 9)
        assert (code, out) == (0, "replayed up to record 9: every state is as it was\n")
        code, out, _ = command("journal", "show", BOLT_TIGHTENING, last, "--database", url, "--json")
        past = json.loads(out)["past"]
        assert code == 0
        assert past["values"] == {name: execution.state[name] for name in execution.automaton.variables}
        code, out, _ = command("journal", "show", BOLT_TIGHTENING, last, "--database", url)
        assert code == 0
        assert "mode automatic, production started" in out
        assert command("journal", "show", BOLT_TIGHTENING, last + 1, "--database", url)[0] == 2
        code, _, err = command("journal", "replay", changed, "--database", url)
        assert code == 2
        assert "another model of the station" in err
