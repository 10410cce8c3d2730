"""libyaml and ruamel.yaml read alike: the same content, of the same types, at the same places."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.reader import ReaderError
from yaml import YAMLError

from sequence_planner.language.syntax import Span
from sequence_planner.model.source import ModelError, SourceText
from sequence_planner.model.yaml import reader
from sequence_planner.model.yaml.reader import Node, compose_slowly, read_text
from support.examples import examples
from support.places import REPOSITORY

FILES = sorted(
    path for folder in ("models", "backend/tests/stations") for path in (REPOSITORY / folder).glob("**/*.yaml")
)
TEXTS = [path.read_text(encoding="utf-8") for path in FILES]
LINES = sorted({line for text in TEXTS for line in text.split("\n")})

# Scalars that mean something else in YAML 1.1, or nothing at all.
SCALARS = (
    *("yes", "no", "on", "off", "y", "n", "true", "True", "TRUE", "tRue", "null", "~", "Null", "=", "<<", "2020-01-01"),
    *("0", "010", "0o17", "0x1F", "0b11", "1_000", "-1", "+1", "1e3", "1.5", ".5", "-.5", "1.", "1e-3", "12:30:45"),
    *(".inf", "-.INF", ".nan", "NaN", "inf", "?", "-", "--", "---", "...", ":", "::", "a:b", "a#b", "@", "`", "%"),
    *("&", "&x", "*", "*x", "!", "!x", "!!str", "é", "😀", "\\n"),
)
PIECES = (
    *(
        " ",
        "  ",
        "\n",
        "\n  ",
        "\n    ",
        "\n\n",
        ": ",
        ":",
        "- ",
        "- - ",
        ", ",
        ",",
        "[",
        "]",
        "{",
        "}",
        "#",
        " # c",
        "\n# c\n",
    ),
    *("'", '"', "''", '"a\\\n  b"', '"\\u00e9\\x41\\/"', '"q":', "'s': ", "plain\n  goes on", "&x ", "*x", "<<: *x"),
    *(
        "|",
        ">",
        "|-\n  a\n   b\n",
        ">-\n  a\n  b\n\n  c\n",
        ">+ # c\n  a\n\n",
        "|2\n   a\n",
        "? ",
        "\t",
        "\r",
        "\r\n",
        "\ufeff",
    ),
    *(
        '{"a":1,"b":[true,null]}',
        "[a: 1, b]",
        "key: ",
        "a: &x {b: c}\nd: *x\n",
        "- a: 1\n  b: 2\n",
        "\x85",
        "\u2028",
        "😀: é",
    ),
)

mixed = st.lists(st.sampled_from((*PIECES, *SCALARS, *("a", "b"))), max_size=12).map("".join)
# Real lines that are torn apart and spoilt in a few places.
spoilt = st.builds(
    lambda lines, cuts: _spoil("\n".join(lines), cuts),
    st.lists(st.sampled_from(LINES), min_size=1, max_size=6),
    st.lists(st.tuples(st.integers(0, 400), st.integers(0, 2), st.sampled_from(PIECES)), max_size=3),
)


def _spoil(text: str, cuts: list[tuple[int, int, str]]) -> str:
    for at, length, piece in cuts:
        index = at % (len(text) + 1)
        text = text[:index] + piece + text[index + length :]
    return text


@pytest.mark.parametrize("text", TEXTS, ids=[path.name for path in FILES])
def test_all_files_of_the_repository_are_read_alike_and_fast(text: str) -> None:
    assert_alike(text)
    assert fast(text) is not None


@examples(1200)
@given(st.one_of(mixed, spoilt))
def test_any_text_is_read_alike(text: str) -> None:
    assert_alike(text)


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize(
    "form", ["a: {}\n", "- {}\n- x\n", "[{}, x]", "{{a: {}}}", "{}: a\n", "\"{}\": '{}'\n", "a: >-\n  {}\n"]
)
def test_scalars_mean_the_same(form: str, scalar: str) -> None:
    assert_alike(
        form.format(scalar, scalar)
        if form.count("{}") == 2
        else form.replace("{}", scalar).replace("{{", "{").replace("}}", "}")
    )


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\n",
        "# c\n",
        "---\na: 1\n",
        "%YAML 1.1\n---\na: yes\n",
        "a: 1\n---\nb: 2\n",
        "[" * 50_000,
        "- " * 50_000 + "x",
    ],
)
def test_odd_documents(text: str) -> None:
    assert_alike(text)


def fast(text: str) -> Node | None:
    """What libyaml makes of a text; nothing where it is left to ruamel.yaml."""
    try:
        return None if reader._READ_ALIKE_UNLESS.search(text) else reader._Composer(text).root()
    except (YAMLError, reader._NotAlike, RecursionError):
        return None


def assert_alike(text: str) -> None:
    root = fast(text)
    if root is None:
        return
    try:
        reference = compose_slowly(text)
    except (MarkedYAMLError, ReaderError) as error:
        raise AssertionError(f"ruamel.yaml refuses it: {error}") from error
    assert reference is not None
    assert ends_of(text, root) == ends_of(text, reference)
    assert said_of(text, root) == said_of(text, reference)


def ends_of(text: str, node: Node) -> list[str]:
    """What stands in each list and mapping in brackets, to the last bracket."""
    inner = (
        node.value
        if node.kind == "sequence"
        else [one for pair in node.value for one in pair]
        if node.kind == "mapping"
        else []
    )
    own = [text[node.start.index : node.end.index]] if node.style == "{" else []
    return own + [end for one in inner if one.start.index >= node.start.index for end in ends_of(text, one)]


def said_of(text: str, root: Node) -> object:
    """Everything that is ever said of a text: content, types, places, and the places within texts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reader, "compose", lambda _: root)
        try:
            document = read_text(text, "file")
        except ModelError as error:
            return str(error)
    return told(document.content), document.places, document.values


def told(content: object) -> object:
    if isinstance(content, dict):
        return [(told(key), told(value)) for key, value in content.items()]
    if isinstance(content, list):
        return [told(value) for value in content]
    if isinstance(content, SourceText):
        spans = [content.at(Span(index, index + 1)) for index in range(min(len(content), 12) + 1)]
        return str(content), content.place, content.raw.rstrip(), spans
    return type(content), str(content)
