"""Instructions of abilities: what they mean, which files they show, and that these go where the model goes."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.core.actor import SYSTEM
from sequence_planner.editor.comparing.diff import text_differences
from sequence_planner.editor.draft import WriteText, applied
from sequence_planner.editor.revisions import Revisions, tree_of
from sequence_planner.editor.symbols.index import ModelPart
from sequence_planner.editor.symbols.rename import renamed
from sequence_planner.mimic.instructions import unshown_of
from sequence_planner.model.files import (
    LARGEST_PICTURE,
    LARGEST_VIDEO,
    content_of,
    is_of_model,
    put_in_place,
    read_files,
    text_of,
    write_files,
)
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station, read_station
from support.places import BOLT_TIGHTENING, MODELS

PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256))
MP4 = b"\0\0\0\x18ftypmp42" + bytes(100)
SVG = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><g id="bolt_pair_1"/><g id="bolt_pair_2"/></svg>'


@pytest.fixture
def model(tmp_path: Path) -> Path:
    folder = shutil.copytree(BOLT_TIGHTENING, tmp_path / "model")
    shutil.rmtree(folder / "instructions")
    (folder / "instructions").mkdir()
    return folder


def instruct(model: Path, instruction: str) -> None:
    """Let the operator's ability have this instruction; the file is written anew from `‹` on."""
    path = model / "resources" / "operator.yaml"
    before, _, after = path.read_text().partition("    instruction:\n")
    path.write_text(f"{before}    instruction: {instruction}\n    enabled:{after.partition('    enabled:')[2]}")


def said(model: Path) -> list[str]:
    """What `check` says of instructions, each with its place within the model."""
    meant = read_station(model)
    return [
        f"{Path(each.place.file).relative_to(model)}:{each.place.line}:{each.place.column}: {each.message}"
        for each in unshown_of(meant.automaton, meant.station)
    ]


def test_each_task_of_a_station_of_ours_has_a_picture_that_can_be_shown() -> None:
    for name in ("truck_engine_station", "bolt_tightening"):
        meant = read_station(MODELS / name)
        assert unshown_of(meant.automaton, meant.station) == []
        tasks = [each for each in meant.automaton.abilities.values() if each.human is not None]
        assert tasks
        for each in tasks:
            assert each.instruction is not None
            assert each.instruction.image is not None
            assert each.instruction.text.keys() == {"en", "sv"}


def test_each_value_of_a_parameter_has_its_own_words_and_picture(model: Path) -> None:
    instruct(model, '{text: {en: "To {pair}", sv: "Till {pair}"}, image: "instructions/{pair}.svg"}')
    ability = read_station(model).automaton.abilities["operator.place_bolt_pair(bolt_pair_2)"]
    assert ability.instruction is not None
    assert ability.instruction.text == {"en": "To bolt pair 2", "sv": "Till skruvpar 2"}
    assert ability.instruction.image == "instructions/bolt_pair_2.svg"
    (model / "instructions" / "bolt_pair_1.svg").write_bytes(SVG)
    (model / "instructions" / "bolt_pair_2.svg").write_bytes(SVG)
    (model / "instructions" / "bolt_pair_4.svg").write_bytes(SVG)
    [finding] = said(model)
    assert finding.endswith(
        "there is no file `instructions/bolt_pair_3.svg`; did you mean `instructions/bolt_pair_4.svg`?"
    )


AT = "resources/operator.yaml:33:26"


@pytest.mark.parametrize(
    ("written", "files", "expected"),
    [
        ("image: instructions/a.png", {"a.png": PNG}, None),
        ("video: instructions/a.mp4", {"a.mp4": MP4}, None),
        ('image: "instructions/a.svg"', {"a.svg": SVG}, None),
        ("image: instructions/a.png", {}, "there is no file `instructions/a.png`"),
        (
            "image: instructions/bolt.png",
            {"bolts.png": PNG},
            "there is no file `instructions/bolt.png`; did you mean `instructions/bolts.png`?",
        ),
        (
            "image: instructions/a.mp4",
            {"a.mp4": MP4},
            "`instructions/a.mp4` is no picture: write `instructions/<name>.svg`",
        ),
        (
            "video: instructions/a.png",
            {"a.png": PNG},
            "`instructions/a.png` is no video: write `instructions/<name>.mp4`",
        ),
        ("image: drawings/a.svg", {}, "`drawings/a.svg` is no picture"),
        ("image: /etc/passwd", {}, "`/etc/passwd` is no picture"),
        ("image: instructions/../a.png", {}, "`instructions/../a.png` is no picture"),
        ('image: "instructions/{par}.png"', {}, "`instructions/{par}.png` is no picture"),
        ("image: instructions/a.png", {"a.png": b"GIF89a"}, "`instructions/a.png`: this is no PNG"),
        ("image: instructions/a.jpg", {"a.jpg": PNG}, "`instructions/a.jpg`: this is no JPG"),
        ("image: instructions/a.webp", {"a.webp": b"RIFF0000WEBX"}, "`instructions/a.webp`: this is no WEBP"),
        ("video: instructions/a.webm", {"a.webm": b""}, "`instructions/a.webm`: this is no WEBM"),
        ("image: instructions/a.svg", {"a.svg": b"<svg"}, "`instructions/a.svg`: this is no SVG, as line 1 says"),
        (
            "image: instructions/a.svg",
            {"a.svg": b"<html/>"},
            "`instructions/a.svg`: this is no SVG: it begins with `html`",
        ),
        (
            'image: "instructions/a.svg#{pair}"',
            {"a.svg": SVG},
            "`instructions/a.svg` has no element `bolt_pair_3`; did you mean `bolt_pair_2`?",
        ),
        (
            "image: instructions/a.png",
            {"a.png": PNG + bytes(LARGEST_PICTURE)},
            "`instructions/a.png`: this has 1000264 bytes, and may have at most 1000000: make it smaller",
        ),
        (
            "video: instructions/a.mp4",
            {"a.mp4": MP4 + bytes(LARGEST_VIDEO)},
            "`instructions/a.mp4`: this has 5000112 bytes, and may have at most 5000000: make it smaller",
        ),
    ],
)
def test_what_cannot_be_shown_is_told_where_it_is_written(
    model: Path, written: str, files: dict[str, bytes], expected: str | None
) -> None:
    """And the station can be run all the same: nobody stands still because of a picture."""
    instruct(model, f"{{{written}}}")
    for name, content in files.items():
        (model / "instructions" / name).write_bytes(content)
    prepare_station(model)
    found = [each for each in said(model) if each.startswith("resources/")]
    if expected is None:
        assert said(model) == []
    else:
        [finding] = found
        assert finding.startswith(f"{AT}: {expected}")


def test_a_file_that_nothing_names_is_looked_at_as_well(model: Path) -> None:
    (model / "instructions" / "a.gif").write_bytes(b"GIF89a")
    (model / "instructions" / "b.png").write_bytes(b"GIF89a")
    instruct(model, "{text: Do it}")
    first, second = said(model)
    assert first.startswith(
        "instructions/a.gif:1:1: this is not read: it is a file <name>.<svg, png, jpg, webp, mp4, webm>"
    )
    assert second == "instructions/b.png:1:1: this is no PNG, whatever its name says: save it as one"


def test_check_tells_it(model: Path) -> None:
    instruct(model, "{image: instructions/a.png}")
    [told] = [each for each in prepare_station(model).suspicions() if each.kind == "not-shown"]
    assert told.message == "there is no file `instructions/a.png`"


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("{}", "write a `text`, an `image` or a `video`"),
        ("{picture: instructions/a.png}", "`picture` is not known here"),
        ("{text: ''}", "write a text: this one is empty"),
        ("{image: [a]}", "expected a text, found a list"),
    ],
)
def test_an_instruction_of_another_form_is_refused(model: Path, written: str, expected: str) -> None:
    instruct(model, written)
    with pytest.raises(ModelError, match=r"operator\.yaml:33:") as refused:
        read_station(model)
    assert expected in str(refused.value)


# What is no text goes where the model goes, to the byte.


@given(st.binary(max_size=300))
def test_what_is_no_text_is_known_by_a_text(content: bytes) -> None:
    for path in ("instructions/a.png", "instructions/a.webm"):
        text = text_of(path, content)
        assert text is not None
        assert content_of(path, text) == content


def test_it_is_part_of_the_model(model: Path, tmp_path: Path) -> None:
    (model / "instructions" / "a.png").write_bytes(PNG)
    (model / "instructions" / "a.svg").write_bytes(SVG)
    files = read_files(model)
    assert files["instructions/a.svg"] == SVG.decode()
    write_files(files, tmp_path / "copy")
    assert (tmp_path / "copy" / "instructions" / "a.png").read_bytes() == PNG
    put_in_place({path: text for path, text in files.items() if path != "instructions/a.png"}, model)
    assert not (model / "instructions" / "a.png").exists()
    put_in_place(files, model)
    assert (model / "instructions" / "a.png").read_bytes() == PNG
    assert not any(
        map(
            is_of_model,
            ("instructions/a.gif", "instructions/../a.png", "instructions/b/a.png", "a.png", "drawings/a.png"),
        )
    )


def test_a_revision_has_it_as_a_file_that_git_reads(model: Path, tmp_path: Path) -> None:
    (model / "instructions" / "a.png").write_bytes(PNG)
    files = read_files(model)
    revisions = Revisions(tmp_path / "revisions.git")
    saved = revisions.save(files, files, "With a picture", "", SYSTEM, 1000.0)
    assert revisions.files(saved.id) == files
    assert saved.tree == tree_of(files)
    alone = {**os.environ, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    subprocess.run(["git", "clone", "-q", "revisions.git", "copy"], cwd=tmp_path, check=True, env=alone)
    assert (tmp_path / "copy" / "instructions" / "a.png").read_bytes() == PNG
    others = {**files, "instructions/a.png": text_of("instructions/a.png", PNG + b"x") or ""}
    assert text_differences(files, others) == {
        "instructions/a.png": "Binary files a/instructions/a.png and b/instructions/a.png differ\n"
    }


def test_an_edit_can_give_it_and_nothing_that_is_too_large_or_none() -> None:
    edit = WriteText(file="instructions/a.png", was=None, text=text_of("instructions/a.png", PNG))
    assert content_of("instructions/a.png", applied({}, [edit])["instructions/a.png"]) == PNG
    with pytest.raises(EditError, match="written in base 64"):
        applied({}, [WriteText(file="instructions/a.png", was=None, text="no bytes")])
    too_large = text_of("instructions/a.mp4", bytes(LARGEST_PICTURE + 1))  # that of a video may be larger
    with pytest.raises(EditError, match="has 1000001 bytes, and may have at most 1000000"):
        applied({}, [WriteText.model_construct(file="instructions/a.png", was=None, text=too_large)])


def test_its_parameters_follow_renames(model: Path) -> None:
    instruct(model, '{text: "To {pair}", image: "instructions/{pair}.svg"}')
    changed = renamed(read_files(model), ModelPart("parameter", "operator.place_bolt_pair", "pair"), "which")
    text = changed["resources/operator.yaml"] or ""
    assert '{text: "To {which}", image: "instructions/{which}.svg"}' in text
