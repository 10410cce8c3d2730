"""Drawings of a station's own: what is kept of them draws and does nothing else, and their elements follow values."""

from __future__ import annotations

import shutil
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.breaking import write
from sequence_planner.automaton.findings import Findings
from sequence_planner.editor.symbols.index import ModelPart
from sequence_planner.editor.symbols.rename import renamed
from sequence_planner.mimic.picture import picture_of
from sequence_planner.mimic.svg import ATTRIBUTES, ELEMENTS, MOST_BYTES, MOST_ELEMENTS, drawing_of
from sequence_planner.mimic.views import MimicDrawing, MimicView
from sequence_planner.model.files import is_of_model, read_files
from sequence_planner.station import prepare_station
from support.places import BOLT_TIGHTENING, MODELS

OPEN = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 50">'


def read(inner: str, opening: str = OPEN) -> tuple[MimicDrawing | None, list[str]]:
    """What a drawing is, and what is said of it, each with its line and column."""
    findings = Findings()
    drawing = drawing_of(f"{opening}\n{inner}\n</svg>", "x.svg", findings)
    return drawing, [f"{each.place.line}:{each.place.column} {each.message}" for each in findings.all]


# What nobody may get into the page, beside what draws.
NAMES = st.sampled_from(
    [
        *sorted(ELEMENTS),
        *("script", "foreignObject", "style", "image", "a", "animate", "set", "iframe", "svg", "filter", "SCRIPT", "x"),
    ]
)
WORDS = st.sampled_from(
    [
        *sorted(ATTRIBUTES),
        *("onload", "onclick", "ONERROR", "style", "xlink:href", "src", "class", "filter", "mask", "xml:base", "begin"),
    ]
)
VALUES = st.one_of(
    st.sampled_from(
        [
            "url(#a)",
            "url(http://evil.example/x)",
            "url('javascript:alert(1)')",
            "javascript:alert(1)",
            "data:text/html,x",
            "http://evil.example/#a",
            "#a",
            "a",
            "1 2 3",
            "var(--ink)",
            "var(--evil)",
            "fill: url(http://evil.example); stroke: red",
            "background: url(//evil.example)",
            "expression(alert(1))",
            "@import 'x'",
            "none",
        ]
    ),
    st.text(st.characters(blacklist_categories=("Cs", "Cc"), max_codepoint=0x2FFF), max_size=12),
)


def element(name: str, attributes: dict[str, str], inner: list[str]) -> str:
    """An element as it is written."""
    written = "".join(f" {each}={quoteattr(value)}" for each, value in attributes.items())
    return f"<{name}{written}>{''.join(inner)}</{name}>"


TREES = st.recursive(
    st.sampled_from(["", "words", "<![CDATA[<script>]]>", "<!-- x -->", "<?x y?>", "&lt;script&gt;"]),
    lambda inner: st.builds(element, NAMES, st.dictionaries(WORDS, VALUES, max_size=4), st.lists(inner, max_size=3)),
    max_leaves=12,
)


@given(TREES)
def test_what_is_kept_has_only_names_and_values_that_draw(tree: str) -> None:
    """Whatever is in a file: no other element, no other attribute, nothing that names another place."""
    drawing, _ = read(tree)
    assert drawing is not None
    ids = {each.attributes["id"] for each in drawing.elements if "id" in each.attributes}
    for number, each in enumerate(drawing.elements):
        assert each.name in ELEMENTS or (each.name == "" and each.attributes == {})
        assert each.inside is None or each.inside < number
        for name, value in each.attributes.items():
            assert name in ATTRIBUTES
            assert not any(word in value.lower() for word in ("http", "javascript:", "data:", "//", "import", "evil"))
            if name == "href":
                assert value[0] == "#" and value[1:] in ids
            if "url(" in value:
                assert value.startswith("url(#") and value[5:-1] in ids


@pytest.mark.parametrize(
    ("inner", "message"),
    [
        ("<script>alert(1)</script>", "2:1 `script` is left out"),
        ('<g>\n <rect onclick="x()"/></g>', "3:2 `onclick` is left out: nothing in a drawing runs"),
        ('<use href="http://evil.example/#a"/>', "2:1 `href` is left out: it may only name an element of this drawing"),
        ('<use xlink:href="data:x"/>', "2:1 `href` is left out"),
        ('<rect style="fill: url(http://evil.example)"/>', "2:1 `fill` is left out"),
        ('<rect fill="var(--evil)"/>', "2:1 `fill` is left out: `var(--evil)` is not drawn"),
        ('<g id="wheel"/><use href="#weel"/>', "2:16 there is no element `weel`; did you mean `wheel`?"),
        ('<g id="a"><use href="#a"/></g>', "2:11 `#a` is left out: it is drawn within itself"),
        ('<g id="a"/><g id="a"/>', "2:12 two elements are called `a`"),
        ('<image href="x.png"/>', "2:1 `image` is left out"),
        ("<style>@import url(x)</style>", "2:1 `style` is left out"),
    ],
)
def test_what_is_left_out_is_told_at_its_place(inner: str, message: str) -> None:
    """And the rest is drawn."""
    drawing, told = read(inner + '<circle r="1"/>')
    assert drawing is not None
    assert drawing.elements[-1].name == "circle"
    assert len(told) == 1
    assert told[0].startswith(message)


def test_what_editors_write_for_themselves_is_left_out_without_a_word() -> None:
    """A drawing saved by a common editor has nothing wrong with it."""
    drawing, told = read(
        '<sodipodi:namedview xmlns:sodipodi="http://s.example" sodipodi:x="1"><g/></sodipodi:namedview>'
        "<metadata><x/></metadata><title>Wheel</title>"
        '<path class="a" data-name="b" style="fill:#fff;-inkscape-font:x;stroke:none" d="M0 0h1"/>'
    )
    assert told == []
    assert drawing is not None
    [path] = drawing.elements
    assert path.attributes == {"fill": "#fff", "stroke": "none", "d": "M0 0h1"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<svg", "1:1 this is no SVG: unclosed token"),
        (f"{OPEN}<g></svg>", "this is no SVG: mismatched tag"),
        (f"{OPEN}&x;</svg>", "this is no SVG: undefined entity"),
        ("<html/>", "1:1 this is no SVG: it begins with `html`"),
        ("<svg/>", "1:1 nobody knows how large this is"),
        ('<svg viewBox="0 0 0 9"/>', "1:1 nobody knows how large this is"),
        (f'<!DOCTYPE svg [<!ENTITY x "y">]>{OPEN}&x;</svg>', "declarations of its own are not read"),
        (f'<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]>{OPEN}&x;</svg>', "declarations of its own"),
        (OPEN + "<g>" * 200 + "</g>" * 200 + "</svg>", "elements are nested more than 100 deep"),
        (OPEN + "<g/>" * (MOST_ELEMENTS + 1) + "</svg>", "a drawing has at most 5000 elements"),
        (OPEN + " " * MOST_BYTES + "</svg>", "at most 200000 are drawn"),
    ],
    ids=["cut", "mismatched", "entity", "html", "no size", "size 0", "bomb", "outside", "deep", "many", "long"],
)
def test_a_file_that_is_no_drawing_is_told_and_nothing_of_it_is_drawn(text: str, message: str) -> None:
    """A drawing stops no station."""
    findings = Findings()
    assert drawing_of(text, "x.svg", findings) is None
    [found] = findings.all
    assert message in f"{found.place.line}:{found.place.column} {found.message}"


def test_a_drawing_that_uses_itself_again_and_again_draws_no_more_than_a_page_can_bear() -> None:
    """Ten uses of ten uses of ten uses ... are a million circles."""
    levels = "".join(f'<g id="l{n + 1}">{f"""<use href="#l{n}"/>""" * 10}</g>' for n in range(6))
    drawing, told = read(f'<circle id="l0" r="1"/>{levels}')
    assert drawing is not None
    assert any("too much would be drawn" in each for each in told)
    ids = {each.attributes.get("id"): number for number, each in enumerate(drawing.elements)}

    def drawn(number: int) -> int:
        used = [each for each in drawing.elements if each.inside == number and "href" in each.attributes]
        return 1 + len(used) + sum(drawn(ids[each.attributes["href"][1:]]) for each in used)

    assert sum(drawn(number) for number, each in enumerate(drawing.elements) if each.inside is None) < 30_000


def test_a_doctype_without_declarations_is_what_old_editors_write() -> None:
    """It is read, and what it names is not fetched."""
    doctype = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://evil.example/svg11.dtd">'
    drawing, told = read("<circle r='1'/>", f"{doctype}{OPEN}")
    assert told == []
    assert drawing is not None
    assert (drawing.width, drawing.height) == (100.0, 50.0)


def test_what_a_root_says_holds_for_all_that_is_in_it() -> None:
    """Many drawings say there that nothing is filled."""
    drawing, told = read("<circle r='1'/>", OPEN.replace(">", " fill='none' width='9' id='all' onload='x()'>"))
    assert [each.partition(" ")[2] for each in told] == ["`onload` is left out: nothing in a drawing runs"]
    assert drawing is not None
    around, circle = drawing.elements
    assert (around.name, around.attributes) == ("g", {"fill": "none", "id": "all"})
    assert (circle.name, circle.inside) == ("circle", 0)


# Drawings in a picture.

DRAWING = f'{OPEN}<path id="frame" d="M0 0h9"/><circle id="lamp" r="3"/><text id="number">0</text></svg>'
SYMBOL = "symbols:\n  arm:\n    at: [0, 0]\n    drawing: drawings/arm.svg\n"


def view_of(folder: Path, text: str, drawing: str = DRAWING) -> tuple[MimicView, list[str], list[str]]:
    """The picture of the bolt station with this text and this drawing; the places of its marks; what `check` says."""
    station = Path(shutil.copytree(BOLT_TIGHTENING, folder / "station"))
    write(station, "drawings/arm.svg", drawing)
    places = write(station, "mimic.yaml", text)
    ready = prepare_station(station)
    return picture_of(ready.automaton, ready.written), places, [str(each) for each in ready.suspicions()]


def test_elements_follow_values(tmp_path: Path) -> None:
    """By whether they are seen, their colour and their text."""
    view, _, _ = view_of(
        tmp_path,
        f"""{SYMBOL}    bind:
      frame: {{visible: {{robot.pose: home}}}}
      lamp: {{role: high, when: {{robot.moving: true}}}}
      number: {{text: {{en: "at {{robot.pose}}", sv: "vid {{robot.pose}}"}}}}
    slots:
      - {{at: [9, 9], title: Tool, drawing: drawings/arm.svg, holds: {{robot.moving: true}}}}
""",
    )
    assert view.findings == []
    [symbol] = view.symbols
    assert symbol.drawing is not None
    frame, lamp, number = symbol.drawing.bound
    assert (frame.element, frame.visible[0].variable, frame.visible[0].values) == ("frame", "robot.pose", ["home"])
    assert (lamp.role, lamp.when[0].variable) == ("high", "robot.moving")
    assert number.text == {"en": "at {robot.pose}", "sv": "vid {robot.pose}"}
    assert symbol.slots[0].drawing is not None
    assert symbol.slots[0].drawing.bound == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("    bind: {‹frme: {role: high}}\n", "there is no element `frme`; did you mean `frame`?"),
        ("    bind: {frame: {visible: {‹robot.posse: home}}}\n", "there is no variable `robot.posse`; did you mean"),
        (
            "    bind: {lamp: {role: low, when: {robot.pose: ‹hom}}}\n",
            "`robot.pose` is never `hom`; did you mean `home`",
        ),
        ("    bind: {lamp: {when: {‹robot.pose: home}}}\n", "there is no `role` here"),
        ("    bind: {frame: {text: ‹a}}\n", "`frame` is a `path`, and only a `text` or `tspan` says something"),
        (
            "    bind: {number: {text: ‹'{robot.poze}'}}\n",
            "there is no variable `robot.poze`; did you mean `robot.pose`?",
        ),
    ],
)
def test_what_is_bound_and_not_there_is_told_and_the_rest_is_drawn(tmp_path: Path, text: str, message: str) -> None:
    """With the nearest name, where the page and `check` can show it."""
    view, [place], checked = view_of(tmp_path, SYMBOL + text)
    [finding] = view.findings
    assert place.endswith(f"/{finding.file}:{finding.line}:{finding.column}")  # wherever the station's folder is
    assert not Path(finding.file).is_absolute()
    assert finding.message.startswith(message)
    assert view.symbols[0].drawing is not None
    assert [each for each in checked if each.startswith(f"{place}: warning: {message}")]


def test_a_drawing_that_is_not_there_is_told_with_the_nearest_name(tmp_path: Path) -> None:
    """The symbol is drawn as one without a drawing."""
    text = SYMBOL.replace("drawings/arm.svg", "‹drawings/amr.svg")
    view, [place], _ = view_of(tmp_path, text)
    [finding] = view.findings
    assert place.endswith(f"/{finding.file}:{finding.line}:{finding.column}")  # wherever the station's folder is
    assert not Path(finding.file).is_absolute()
    assert finding.message == "there is no file `drawings/amr.svg`; did you mean `drawings/arm.svg`?"
    assert view.symbols[0].drawing is None


def test_what_is_wrong_in_a_drawing_is_told_by_its_file(tmp_path: Path) -> None:
    """`check` says it, and the page below the picture."""
    view, _, checked = view_of(tmp_path, SYMBOL, f"{OPEN}\n  <script/></svg>")
    [finding] = view.findings
    assert (Path(finding.file).name, finding.line, finding.column) == ("arm.svg", 2, 3)
    assert any("arm.svg:2:3: warning: `script` is left out" in each for each in checked)


def test_names_in_bindings_follow_renames(tmp_path: Path) -> None:
    """As all other names of the picture do."""
    files = read_files(MODELS / "truck_engine_station")
    assert "frame: {visible: {ladder_frame: on_engine}}" in files["mimic.yaml"]
    changed = renamed(files, ModelPart("value", "ladder_frame_state", "on_engine"), "laid")
    assert "frame: {visible: {ladder_frame: laid}}" in (changed["mimic.yaml"] or "")
    changed = renamed(files, ModelPart("variable", None, "ladder_frame"), "frame_at")
    assert "frame: {visible: {frame_at: on_engine}}" in (changed["mimic.yaml"] or "")


def test_drawings_are_files_of_the_model() -> None:
    """They are saved, compared and deployed with it."""
    assert "drawings/engine.svg" in read_files(MODELS / "truck_engine_station")
    assert is_of_model("drawings/engine.svg")
    assert not any(map(is_of_model, ("drawings/engine.png", "drawings/../x.svg", "drawings/a/b.svg", "engine.svg")))
