"""The model as engineers edit it over REST: shared, checked, saved and compared, without touching what runs."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import ClientConnection

from sequence_planner.auth.roles import Role
from sequence_planner.core.actor import ActorKind
from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal import audit
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.model.files import read_files
from sequence_planner.server.settings import Settings
from support.network import free_port
from support.places import BOLT_TIGHTENING
from support.server import Controller, Loop, Server, listen
from support.waiting import PATIENCE, until

from .test_acting import problem

MODEL = "/api/v1/model"
TITLE = {
    "kind": "set",
    "file": "station.yaml",
    "path": ["title", "en"],
    "was": "Bolt tightening station",
    "value": "Bolts",
}


@pytest.fixture
def model(tmp_path: Path) -> Path:
    return shutil.copytree(BOLT_TIGHTENING, tmp_path / "model")


@pytest.fixture
def server(loop: Loop, settings: Settings, model: Path) -> Iterator[Server]:
    server = Server(
        loop,
        Settings(**{**vars(settings), "model": model, "port": free_port()}),  # the controller is not there
    )
    server.start()
    yield server
    server.stop()


@pytest.fixture
def eva(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


@pytest.fixture
def adam(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


def read(client: httpx.Client, address: str = "", **question: object) -> dict[str, Any]:
    answer = client.get(f"{MODEL}{address}", params={key: str(value) for key, value in question.items()})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def change(client: httpx.Client, *edits: object, title: str = "an edit") -> httpx.Response:
    return client.post(f"{MODEL}/changes", json={"title": title, "edits": edits})


def made(client: httpx.Client, *edits: object, title: str = "an edit") -> dict[str, Any]:
    answer = change(client, *edits, title=title)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def checked(client: httpx.Client) -> dict[str, Any]:
    """What is found of the draft as it is now."""
    found: list[dict[str, Any]] = []

    def done() -> bool:
        found.append(read(client, "/check"))
        return bool(found[-1]["state"] == "done")

    until(done)
    return found[-1]


def save(client: httpx.Client, name: str, number: int) -> httpx.Response:
    return client.post(f"{MODEL}/revisions", json={"number": number, "name": name})


def test_the_draft_begins_as_the_station_is(eva: httpx.Client, model: Path) -> None:
    draft = read(eva)
    assert set(draft["files"]) == set(read_files(model))
    assert {each["state"] for each in draft["files"].values()} == {"same"}
    assert (draft["undo"], draft["redo"]) == (None, None)
    files = read(eva, "/files", path="station.yaml")["files"]
    assert files["station.yaml"]["content"]["title"]["en"] == "Bolt tightening station"
    assert files["station.yaml"]["text"] == (model / "station.yaml").read_text(encoding="utf-8")
    assert set(read(eva, "/files")["files"]) == set(draft["files"])
    assert read(eva, "/files", path="resources/none.yaml")["files"] == {"resources/none.yaml": None}


def test_an_edit_is_seen_by_the_other_and_undone_by_who_made_it(
    eva: httpx.Client, adam: httpx.Client, model: Path
) -> None:
    before = read_files(model)
    changed = made(eva, TITLE, title="another title")
    assert changed["files"]["station.yaml"]["content"]["title"]["en"] == "Bolts"
    draft = read(adam)
    assert (draft["number"], draft["undo"]) == (changed["number"], None)
    assert draft["files"]["station.yaml"]["state"] == "changed"
    assert draft["changes"][0]["title"] == read(eva)["undo"] == "another title"
    refused = change(adam, TITLE)
    problem(refused, 409, "part-changed")
    assert "by Engineer" in refused.json()["detail"]
    assert "Nothing was changed" in refused.json()["detail"]
    problem(adam.post(f"{MODEL}/undo", json={}), 422, "edit-refused")
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    assert read(adam)["files"]["station.yaml"]["state"] == "same"
    assert eva.post(f"{MODEL}/redo", json={}).status_code == 200
    assert read(adam)["files"]["station.yaml"]["state"] == "changed"
    assert read_files(model) == before  # nothing of the station is touched


def test_edits_of_other_parts_go_together(eva: httpx.Client, adam: httpx.Client) -> None:
    text = read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["text"]
    made(eva, TITLE)
    mine = text.replace("request: [none,", "request: [nothing,")
    made(adam, {"kind": "text", "file": "station.yaml", "was": text, "text": mine})
    content = read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["content"]
    assert (content["title"]["en"], content["enumerations"]["request"][0]) == ("Bolts", "nothing")
    problem(change(adam, {"kind": "text", "file": "station.yaml", "was": text, "text": ""}), 409, "part-changed")


@pytest.mark.parametrize(
    "edit",
    [
        {"kind": "set", "file": "../people.yaml", "path": ["a"], "was": 1, "value": 2},
        {"kind": "text", "file": "stages/own.py", "was": None, "text": "import os"},
        {"kind": "text", "file": "resources/a.yaml", "was": None, "text": "a: \0"},
        {"kind": "add", "file": "station.yaml", "path": ["title"], "value": "x"},
        {"kind": "add", "file": "station.yaml", "path": ["enumerations", "request", "x"], "value": "x"},
    ],
)
def test_what_cannot_be_edited_is_said_and_nothing_is_done(eva: httpx.Client, edit: dict[str, object]) -> None:
    number = read(eva)["number"]
    problem(change(eva, TITLE, edit), 422, "edit-refused")
    assert read(eva)["number"] == number


@pytest.mark.parametrize("edits", [[], [{"kind": "set"}], [{"kind": "drop", "file": "a"}], [{}], "all"])
def test_what_is_no_edit_is_invalid(eva: httpx.Client, edits: object) -> None:
    problem(eva.post(f"{MODEL}/changes", json={"title": "x", "edits": edits}), 422, "invalid-request")


def test_a_large_file_may_be_written_and_a_larger_one_not(eva: httpx.Client) -> None:
    large = "# " + "x" * 900_000 + "\ntitle: a\n"
    made(eva, {"kind": "text", "file": "resources/large.yaml", "was": None, "text": large})
    twice = {"kind": "text", "file": "resources/large.yaml", "was": large, "text": large + large}
    problem(change(eva, twice), 422, "invalid-request")
    problem(
        eva.post(f"{MODEL}/undo", content=b" " * 70_000, headers={"Content-Type": "application/json"}),
        413,
        "body-too-large",
    )


def test_the_check_follows_the_draft(eva: httpx.Client) -> None:
    assert checked(eva)["findings"] == []
    goal = {"kind": "set", "file": "operations.yaml", "path": ["prepare_planning_scene", "goal"]}
    number = made(eva, {**goal, "was": "robot.tool_is_attached", "value": "robot.is_attached"})["number"]
    found = checked(eva)
    assert (found["number"], found["summary"]) == (number, None)
    assert [(each["file"], each["severity"]) for each in found["findings"]] == [("operations.yaml", "error")]


def test_an_ability_is_seen_to_go_through_the_run_that_shows_a_finding(eva: httpx.Client) -> None:
    never = "never_placed:\n  forbidden: bolts[bolt_pair_1] == placed\n"
    text = read(eva, "/files")["files"]["specifications.yaml"]["text"]
    number = made(eva, {"kind": "text", "file": "specifications.yaml", "was": text, "text": text + never})["number"]
    findings = checked(eva)["findings"]
    at = next(place for place, each in enumerate(findings) if each["trace"] and each["trace"]["steps"])
    steps = findings[at]["trace"]["steps"]
    ability = next(name for step in steps if step["kind"] == "start" for name in step["names"])
    path = f"{MODEL}/check/findings/{at}/run"
    run = eva.get(path, params={"number": number, "ability": ability}).json()
    assert len(run) == len(steps) + 1
    assert {each["name"] for each in run} == {ability}
    assert run[0]["executing"]["holds"] is False
    started = next(place for place, step in enumerate(steps) if ability in step["names"])
    assert run[started]["enabled"]["holds"] is True
    assert all(each["done"] for each in run[started + 1]["start_actions"])
    problem(eva.get(path, params={"number": number - 1, "ability": ability}), 404, "no-run")
    problem(eva.get(path, params={"number": number, "ability": "robot.fly"}), 404, "no-run")
    problem(
        eva.get(f"{MODEL}/check/findings/{len(findings)}/run", params={"number": number, "ability": ability}),
        404,
        "no-run",
    )


def _workshop(stream: ClientConnection, number: int) -> dict[str, Any]:
    """The view once the check of that change is done."""
    while True:
        workshop: dict[str, Any] = json.loads(stream.recv(PATIENCE))["workshop"]
        if workshop["check"]["number"] == number and workshop["check"]["state"] == "done":
            return workshop


def test_whoever_looks_is_told(server: Server, eva: httpx.Client, model: Path) -> None:
    headers = server.cookie(server.session(server.person(Role.VIEWER))[0])
    with listen(server, f"ws://127.0.0.1:{server.settings.port}{MODEL}/stream", headers=headers) as stream:
        first = json.loads(stream.recv(PATIENCE))["workshop"]
        assert first["number"] == 1
        number = made(eva, TITLE, title="another title")["number"]
        seen = _workshop(stream, number)
        assert seen["last"]["title"] == "another title"
        assert seen["files"]["station.yaml"]["state"] == "changed"
        assert seen["check"]["summary"]["title"] == "Bolts"
        # A deployment puts the draft in the place of the station's files: it is no other draft, and is as they are now.
        text = read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["text"]
        (model / "station.yaml").write_text(text, encoding="utf-8")
        read(eva, "/revisions")
        deployed = json.loads(stream.recv(PATIENCE))["workshop"]
        assert deployed["number"] == number
        assert deployed["files"]["station.yaml"]["state"] == "same"
        assert deployed["check"]["state"] == "done"


def test_what_happens_to_the_files_of_the_station_is_taken_up(eva: httpx.Client, model: Path) -> None:
    made(eva, TITLE)
    path = model / "operations.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("priority: 1", "priority: 3"), encoding="utf-8")
    files = read(eva, "/files")["files"]
    assert files["operations.yaml"]["content"]["tighten_bolt_pair"]["priority"] == 3
    assert files["station.yaml"]["content"]["title"]["en"] == "Bolts"
    states = {path: each["state"] for path, each in read(eva)["files"].items() if each["state"] != "same"}
    assert states == {"station.yaml": "changed"}


def test_a_revision_is_saved_and_taken_back(eva: httpx.Client, adam: httpx.Client) -> None:
    number = made(eva, TITLE)["number"]
    problem(save(eva, "Bolts", number - 1), 409, "stale-draft")
    problem(save(eva, "  ", number), 422, "edit-refused")
    saved = save(eva, "Bolts", number)
    assert saved.status_code == 201
    assert (saved.json()["draft"], saved.json()["running"]) == (True, False)
    problem(save(adam, "Bolts again", number), 422, "edit-refused")
    newest, oldest = read(eva, "/revisions")["revisions"]
    assert (newest["id"], oldest["running"], oldest["draft"]) == (saved.json()["id"], True, False)
    back = adam.post(f"{MODEL}/revisions/{oldest['id']}/restore", json={"number": number})
    assert back.status_code == 200
    assert {each["state"] for each in read(eva)["files"].values()} == {"same"}
    assert adam.post(f"{MODEL}/undo", json={}).status_code == 200
    assert read(eva, "/revisions")["revisions"][0]["draft"]
    problem(adam.post(f"{MODEL}/revisions/{'0' * 40}/restore", json={"number": number + 2}), 404, "no-revision")


def test_places_in_which_the_draft_differs_are_counted(eva: httpx.Client) -> None:
    assert read(eva, "/changes")["changes"] == 0
    made(eva, TITLE)
    number = made(eva, {"kind": "text", "file": "resources/notes.yaml", "was": None, "text": "one: 1\ntwo: 2\n"})[
        "number"
    ]
    assert read(eva, "/changes") == {"number": number, "changes": 2, "waits": None}


def test_versions_are_compared(eva: httpx.Client) -> None:
    made(eva, TITLE)
    number = made(
        eva,
        {"kind": "set", "file": "operations.yaml", "path": ["tighten_bolt_pair", "priority"], "was": 1, "value": 4},
    )["number"]
    id = save(eva, "More", number).json()["id"]
    found = read(eva, "/comparison", old="running", new=id)
    assert list(found["text"]) == ["operations.yaml", "station.yaml"]
    (part,) = found["parts"]
    assert (part["name"], part["over"]) == ("tighten_bolt_pair(pair)", "all pair in bolt_pair")
    assert part["members"] == [f"tighten_bolt_pair(bolt_pair_{n})" for n in (1, 2, 3)]
    assert found["doing"] == ""
    begun = read(eva, "/comparison", old="running", wait="0")
    assert begun["doing"] or begun["parts"] is not None
    assert read(eva, "/comparison", old=id)["text"] == {}
    problem(eva.get(f"{MODEL}/comparison", params={"old": "0" * 40}), 404, "no-revision")
    problem(eva.get(f"{MODEL}/comparison", params={"old": "HEAD"}), 422, "invalid-request")


def test_a_part_is_renamed_wherever_it_is_named(eva: httpx.Client) -> None:
    found = read(eva, "/usages", part="variable:robot.pose")
    assert {each["file"] for each in found["dependants"]} >= {"resources/nutrunner.yaml", "specifications.yaml"}
    assert [each["line"] for each in found["usages"] if each["declares"]]
    answer = eva.post(f"{MODEL}/rename", json={"part": "enumeration:bolt_state", "name": "state_of_bolts"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["files"]["station.yaml"]["content"]["estimated"]["bolts"]["type"] == "state_of_bolts"
    assert checked(eva)["findings"] == []
    assert read(eva)["undo"] == "bolt_state is called state_of_bolts"
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    assert {each["state"] for each in read(eva)["files"].values()} == {"same"}


def test_what_could_be_said_shorter_is_one_change(eva: httpx.Client, adam: httpx.Client) -> None:
    found = read(eva, "/folds")
    assert (found["number"], found["usable"], found["whole"]) == (read(eva)["number"], True, True)
    predicate = next(each for each in found["folds"] if each["kind"] == "predicate")
    assert [each["file"] for each in predicate["places"]] == ["operations.yaml", "resources/engine.yaml"]
    (named,) = read(eva, "/folds", fold=predicate["id"], name="is_done")["folds"]
    made(eva, *named["edits"])
    files = read(eva, "/files")["files"]
    assert files["station.yaml"]["content"]["predicates"] == {
        "is_done": "all pair in bolt_pair: bolts[pair] == tightened"
    }
    assert files["resources/engine.yaml"]["content"]["abilities"]["next_engine"]["enabled"] == "is_done"
    assert checked(eva)["findings"] == []
    assert predicate["id"] not in [each["id"] for each in read(eva, "/folds")["folds"]]
    problem(adam.post(f"{MODEL}/changes", json={"title": "once more", "edits": named["edits"]}), 409, "part-changed")
    problem(eva.get(f"{MODEL}/folds", params={"fold": predicate["id"]}), 422, "edit-refused")
    problem(eva.get(f"{MODEL}/folds", params={"fold": "../"}), 422, "invalid-request")
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    assert {each["state"] for each in read(eva)["files"].values()} == {"same"}
    edit = {"kind": "set", "file": "station.yaml", "path": ["rest"], "value": "robot.pos == home"}
    made(eva, {**edit, "was": read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["content"]["rest"]})
    assert read(eva, "/folds")["usable"] is False


def test_an_outline_becomes_documents_that_are_one_change(eva: httpx.Client) -> None:
    templates = read(eva, "/outlines")["templates"]
    assert set(templates) == {"bolt", "person-and-clamp", "pick-and-place"}
    preview = eva.post(f"{MODEL}/outlines/preview", json=templates["bolt"]).json()
    assert (preview["problems"], preview["errors"]) == ([], [])
    present = {path: each["text"] for path, each in read(eva, "/files")["files"].items()}
    made(
        eva,
        *(
            {"kind": "text", "file": file, "was": present.get(file), "text": preview["files"].get(file)}
            for file in sorted(preview["files"].keys() | present.keys())
            if present.get(file) != preview["files"].get(file)
        ),
    )
    assert [each for each in checked(eva)["findings"] if each["severity"] == "error"] == []
    unfinished = eva.post(f"{MODEL}/outlines/preview", json={**templates["bolt"], "devices": []}).json()
    assert unfinished["files"] == {}
    assert unfinished["problems"][0]["place"] == ["devices"]


def test_the_picture_of_the_draft_is_drawn_as_that_of_the_station(eva: httpx.Client) -> None:
    """What is drawn by hand, what is made without a file, and the file to begin with, which draws the same."""
    found = read(eva, "/mimic")
    files = read(eva)["files"]
    assert (found["number"], found["digest"]) == (read(eva)["number"], files["mimic.yaml"]["digest"])
    assert (found["picture"]["made_from"], found["file"]) == ("file", None)
    assert found["titles"]["nutrunner"] == "Nutrunner"
    at = {"kind": "set", "file": "mimic.yaml", "path": ["symbols", "nutrunner", "at", 0], "was": 24, "value": 28}
    made(eva, at, {**at, "path": ["symbols", "nutrunner", "resource"], "was": "nutrunner", "value": "nutruner"})
    picture = read(eva, "/mimic")["picture"]
    (nutrunner,) = (each for each in picture["symbols"] if each["name"] == "nutrunner")
    assert (nutrunner["box"]["x"], nutrunner["resource"]) == (28, None)
    assert [each["message"] for each in picture["findings"]] == [
        "there is no resource `nutruner`; did you mean `nutrunner`?"
    ]
    text = read(eva, "/files", path="mimic.yaml")["files"]["mimic.yaml"]["text"]
    made(eva, {"kind": "text", "file": "mimic.yaml", "was": text, "text": None})
    without = read(eva, "/mimic")
    assert (without["picture"]["made_from"], without["digest"]) == ("model", None)
    made(eva, {"kind": "text", "file": "mimic.yaml", "was": None, "text": without["file"]})
    drawn = read(eva, "/mimic")
    assert drawn["picture"] == {**without["picture"], "made_from": "file"}
    wrong = {"kind": "set", "file": "station.yaml", "path": ["rest"], "value": "robot.pos == home"}
    made(eva, {**wrong, "was": read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["content"]["rest"]})
    unusable = read(eva, "/mimic")
    assert (unusable["usable"], unusable["picture"]) == (False, None)


def test_the_order_of_operations_follows_the_draft_and_stays_while_that_cannot_be_used(eva: httpx.Client) -> None:
    def order() -> dict[str, Any]:
        found = read(eva, "/operations")
        assert found["number"] == read(eva)["number"]
        return found

    def links(found: dict[str, Any]) -> set[tuple[str, str]]:
        return {(each["before"], each["after"]) for each in found["links"]}

    first, second = "place_bolt_pair(bolt_pair_1)", "place_bolt_pair(bolt_pair_2)"
    before = order()
    assert (before["usable"], before["operations"][first]["lane"]) == (True, "operator")
    assert before["operations"][first]["begins"][0]["text"] == "bolts[bolt_pair_1] == empty"
    assert before["operations"][first]["entry"] == "place_bolt_pair"
    assert (first, "tighten_bolt_pair(bolt_pair_1)") in links(before)
    assert (first, second) not in links(before)
    sequence = {"kind": "add", "file": "operations.yaml", "path": ["both"], "value": {"sequence": [first, second]}}
    made(eva, sequence)
    after = order()
    assert (first, second) in links(after)
    assert [each["text"] for each in after["operations"][second]["turns"]] == ["bolts[bolt_pair_1] == placed"]
    made(eva, {**sequence, "path": ["wrong"], "value": {"sequence": [first, "nobody"]}})
    assert {**order(), "number": after["number"]} == {**after, "usable": False}


def test_the_model_as_a_whole_follows_the_draft(eva: httpx.Client) -> None:
    def tied(part: str) -> set[tuple[str, str]]:
        """What the part uses, and how."""
        found = read(eva, "/graph")
        assert found["number"] == read(eva)["number"]
        things = [each["id"] for each in found["things"]]
        return {(things[tie["thing"]], tie["manner"]) for tie in found["ties"] if things[tie["by"]] == part}

    assert ("variable:bolts", "goal") in tied("operation:new_engine")
    assert ("variable:robot.tool_is_attached", "feeds") in tied("topic:/ur10/planning_scene/state")
    new = {"kind": "set", "file": "operations.yaml", "path": ["new_engine", "goal"], "value": "robot.pose == home"}
    goal = read(eva, "/files", path="operations.yaml")["files"]["operations.yaml"]["content"]["new_engine"]["goal"]
    made(eva, {**new, "was": goal})
    assert {each for each in tied("operation:new_engine") if each[1] == "goal"} == {("variable:robot.pose", "goal")}


@pytest.mark.parametrize(
    ("part", "name"),
    [
        ("enumeration:bolt_state", "pose"),
        ("enumeration:bolt_state", "a b"),
        ("enumeration:none", "some"),
        ("colour:red", "blue"),
    ],
)
def test_what_cannot_be_renamed_is_said(eva: httpx.Client, part: str, name: str) -> None:
    problem(eva.post(f"{MODEL}/rename", json={"part": part, "name": name}), 422, "edit-refused")


START = {"file": "resources/robot.yaml", "path": ["abilities", "move_to_position", "start", "when"]}


def language(client: httpx.Client, what: str, **asked: object) -> dict[str, Any]:
    answer = client.post(f"{MODEL}/language/{what}", json={**START, **asked})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_text_is_checked_completed_explained_and_formatted_as_the_draft_is_now(eva: httpx.Client) -> None:
    assert language(eva, "check", text="pose == home and  bolts[bolt_pair_1]==empty")["problems"] == []
    (wrong,) = language(eva, "check", text="pose == hom")["problems"]
    assert (wrong["start"], wrong["end"]) == (8, 11)
    assert "did you mean `home`?" in wrong["message"]
    found = language(eva, "completion", text="pose == ab", offset=10)
    assert (found["start"], found["end"]) == (8, 10)
    assert "above_engine" in [each["insert"] for each in found["options"]]
    name = language(eva, "hover", text="pose == home", offset=1)["hover"]
    assert (name["names"], name["kind"], name["declared"]["file"]) == (["robot.pose"], "measured", START["file"])
    assert language(eva, "hover", text="pose == home", offset=5)["hover"] is None
    assert language(eva, "format", text="pose==home   and(moving)")["text"] == "pose == home and moving"
    made(eva, {"kind": "add", "file": START["file"], "path": ["estimated", "tired"], "value": {"type": "bool"}})
    assert language(eva, "check", text="not tired")["problems"] == []


def test_what_is_broken_elsewhere_is_no_fault_of_a_text(eva: httpx.Client) -> None:
    assert language(eva, "check", text="nutrunner.tool_is_idle")["problems"] == []
    path = "resources/nutrunner.yaml"
    text = read(eva, "/files", path=path)["files"][path]["text"]
    made(eva, {"kind": "text", "file": path, "was": text, "text": "abilities: ["})
    assert language(eva, "check", text="nutrunner.tool_is_idle")["problems"] == []
    assert language(eva, "check", text="nutrunner.tool_is_odd")["problems"]


def test_without_a_controller_nothing_is_deployed(eva: httpx.Client) -> None:
    body = {"revision": "0" * 40, "number": 1, "reason": "to try"}
    problem(eva.post(f"{MODEL}/deployments", json=body), 503, "controller-unavailable")
    problem(eva.get(f"{MODEL}/transfer"), 503, "controller-unavailable")


def test_a_server_that_does_not_know_the_model_says_so(controller: Controller, lonely_server: Server) -> None:
    with lonely_server.client(Role.ENGINEER) as client:
        problem(client.get(MODEL), 409, "no-model")


def test_engineers_comment_on_the_draft_and_everybody_reads_it(server: Server, eva: httpx.Client) -> None:
    with server.client(Role.VIEWER) as vera:
        assert read(vera, "/comments") == {"comments": []}
        number = read(eva)["number"]
        said = eva.post(f"{MODEL}/comments", json={"text": "Why 12 s?"})
        assert said.status_code == 201
        assert (said.json()["draft"], said.json()["number"]) == (number, 1)
        eva.post(f"{MODEL}/comments", json={"text": "The longest run took 5.8 s.\nSo it is enough."})
        told = read(vera, "/comments")["comments"]
        assert [each["text"] for each in told] == ["Why 12 s?", "The longest run took 5.8 s.\nSo it is enough."]
        assert {each["by"] for each in told} == {said.json()["by"]}
        for text in ("", "x" * 5001):
            problem(eva.post(f"{MODEL}/comments", json={"text": text}), 422, "invalid-request")
        problem(vera.post(f"{MODEL}/comments", json={"text": "I, too"}), 403, "role-too-low")


def test_a_revision_is_approved_by_somebody_else_than_who_saved_it(
    server: Server, eva: httpx.Client, adam: httpx.Client
) -> None:
    made(eva, TITLE)
    saved = eva.post(f"{MODEL}/revisions", json={"number": read(eva)["number"], "name": "Bolts"}).json()
    address = f"{MODEL}/revisions/{saved['id']}/reviews"

    def judged(client: httpx.Client, verdict: str, text: str = "") -> httpx.Response:
        return client.post(address, json={"verdict": verdict, "text": text})

    def known() -> tuple[list[str], list[str]]:
        (found,) = [each for each in read(eva, "/revisions")["revisions"] if each["id"] == saved["id"]]
        return found["approved_by"], found["changes_requested_by"]

    assert known() == ([], [])
    assert "“Bolts”" in problem(judged(eva, "approved"), 403, "same-person")["detail"]
    problem(judged(adam, "withdrawn"), 409, "no-review")
    problem(judged(adam, "changes-requested", "  "), 422, "invalid-request")
    problem(judged(adam, "perhaps"), 422, "invalid-request")
    said = judged(adam, "changes-requested", "Say which bolts.")
    assert said.status_code == 201
    name = said.json()["by"]
    assert known() == ([], [name])
    assert judged(adam, "approved").status_code == 201
    assert known() == ([name], [])
    assert judged(adam, "withdrawn", "I had not seen the second page.").status_code == 201
    assert known() == ([], [])
    problem(judged(adam, "withdrawn"), 409, "no-review")
    told = read(eva, "/comments")["comments"]
    assert [(each["verdict"], each["text"]) for each in told] == [
        ("changes-requested", "Say which bolts."),
        ("approved", ""),
        ("withdrawn", "I had not seen the second page."),
    ]
    assert {each["revision"] for each in told} == {saved["id"]}
    unknown = adam.post(f"{MODEL}/revisions/{'0' * 40}/reviews", json={"verdict": "approved"})
    problem(unknown, 404, "no-revision")
    with server.client(Role.OPERATOR) as otto:
        problem(judged(otto, "approved"), 403, "role-too-low")


def test_verdicts_are_in_the_record_of_who_did_what(server: Server, eva: httpx.Client, adam: httpx.Client) -> None:
    """Each in its chain, in one transaction with the verdict itself: the controller, which is not there, has no part in
    it. What is refused leaves no record.
    """
    made(eva, TITLE)
    saved = eva.post(f"{MODEL}/revisions", json={"number": read(eva)["number"], "name": "Bolts"}).json()
    long = "Say which bolts. " * 100
    for verdict, text in (("changes-requested", long.strip()), ("approved", ""), ("withdrawn", "I had not seen all.")):
        answer = adam.post(f"{MODEL}/revisions/{saved['id']}/reviews", json={"verdict": verdict, "text": text})
        assert answer.status_code == 201
    problem(eva.post(f"{MODEL}/revisions/{saved['id']}/reviews", json={"verdict": "approved"}), 403, "same-person")
    with server.identity.database.reading() as connection:
        records = [each.entry for each in audit.read(connection) if each.entry.subject == "revision Bolts"][::-1]
        assert audit.broken_at(connection) is None
    person = adam.get("/api/v1/session").json()["person"]
    assert {(each.actor.kind, each.actor.id, each.actor.name) for each in records} == {
        (ActorKind.PERSON, person["id"], person["name"])
    }
    assert [(each.action, each.reason) for each in records] == [
        ("revision-changes-requested", long[:LONGEST_REASON]),
        ("revision-approved", None),
        ("revision-verdict-withdrawn", "I had not seen all."),
    ]
    assert all(each.details["revision"] == saved["id"] for each in records)
    assert all(each.details["saved_by"] == saved["by"] for each in records)
    assert [each.details.get("text") for each in records] == [long.strip(), None, None]


def test_where_nothing_can_be_recorded_there_is_no_verdict(
    eva: httpx.Client, adam: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    made(eva, TITLE)
    saved = eva.post(f"{MODEL}/revisions", json={"number": read(eva)["number"], "name": "Bolts"}).json()

    def fails(*_: object) -> None:
        raise StorageError("the journal's end was taken out of the database")

    monkeypatch.setattr(audit, "append", fails)
    refused = adam.post(f"{MODEL}/revisions/{saved['id']}/reviews", json={"verdict": "approved"})
    assert refused.status_code == 503
    assert read(adam, "/comments")["comments"] == []
    assert [each["approved_by"] for each in read(adam, "/revisions")["revisions"] if each["draft"]] == [[]]


def test_others_are_told_what_waits_for_their_approval(
    loop: Loop, settings: Settings, model: Path, server: Server, eva: httpx.Client, adam: httpx.Client
) -> None:
    """From when it is saved until somebody has said what they think of it, it is another draft, or it runs."""

    def waits(client: httpx.Client) -> dict[str, Any] | None:
        found: dict[str, Any] | None = read(client, "/changes")["waits"]
        return found

    def save(name: str) -> dict[str, Any]:
        saved: dict[str, Any] = eva.post(
            f"{MODEL}/revisions", json={"number": read(eva)["number"], "name": name}
        ).json()
        return saved

    made(eva, TITLE)
    save("Bolts")
    assert waits(adam) is None  # nobody says that the station asks for an approval
    controller = Controller(loop, settings.controller_socket)
    identity = controller.view.station.model_copy(update={"deployment_approval": "dual"})
    controller.view = controller.view.model_copy(update={"station": identity})
    controller.start()
    try:
        server.hear_controller()
        until(lambda: waits(adam) is not None)
        assert waits(eva) is None  # what she has saved does not wait for her
        made(eva, {**TITLE, "was": TITLE["value"], "value": "Bolts again"})
        assert waits(adam) is None  # it is not what would be deployed
        second = save("Again")
        told = waits(adam)
        assert told is not None
        assert (told["id"], told["name"], told["by"]) == (second["id"], "Again", second["by"])
        assert told["number"] == len(read(adam, "/revisions")["revisions"])
        address = f"{MODEL}/revisions/{second['id']}/reviews"
        for verdict in ("approved", "changes-requested"):
            assert adam.post(address, json={"verdict": verdict, "text": "Why?"}).status_code == 201
            assert waits(adam) is None
            assert adam.post(address, json={"verdict": "withdrawn"}).status_code == 201
            assert waits(adam) == told
        (model / "station.yaml").write_text(read(eva, "/files", path="station.yaml")["files"]["station.yaml"]["text"])
        until(lambda: waits(adam) is None)  # it runs
    finally:
        controller.stop()


def test_the_state_space_of_the_draft_is_told_folded(eva: httpx.Client) -> None:
    """From the first look, where a choice is made, to a plan on it; and what cannot be shown is refused with why."""
    address, present = f"{MODEL}/what-if/state-space", {"bolts[bolt_pair_1]": "placed"}
    begun = eva.post(address, json={"present": {}})
    assert begun.status_code == 200, begun.text
    view = begun.json()
    assert 1 < view["count"] == len(view["nodes"]) <= view["most"]
    assert view["exact"]
    assert sum(node["initial"] for node in view["nodes"]) == 1
    asked = {
        "variables": ["bolts[bolt_pair_1]"],
        "extent": "supervised",
        "plan": True,
        "until": "bolts[bolt_pair_1] == tightened",
    }
    told = eva.post(address, json={"question": asked, "present": present}).json()
    assert [node["values"] for node in told["nodes"] if node["present"]] == [["placed"]]
    assert told["nodes"][told["path"][-1]["node"]]["values"] == ["tightened"]
    for wrong, why in (([], "at least one"), (["robot.wings"], "there is no variable robot.wings")):
        refused = eva.post(address, json={"question": {"variables": wrong}, "present": present})
        assert why in problem(refused, 422, "not-folded")["detail"]
    unread = eva.post(address, json={"question": {"variables": "robot.pose"}, "present": present})
    problem(unread, 422, "invalid-request")
