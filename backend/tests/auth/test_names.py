"""Names: written in one way, found in spite of case and blanks, and never mistaken for another."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tokens import LONGEST_NAME, clean_name, name_key, name_shape, short
from support.examples import examples


def usable(text: str) -> str | None:
    try:
        return clean_name(text)
    except IdentityRefused as refused:
        assert (refused.slug, refused.status) == ("invalid-name", 422)
        return None


@given(st.text(max_size=150))
@examples(400)
def test_a_name_is_kept_in_one_way(text: str) -> None:
    name = usable(text)
    if name is not None:
        assert clean_name(name) == name
        assert 1 <= len(name) <= LONGEST_NAME
        assert name.isprintable()
        assert " ".join(name.split()) == name
        assert name_key(name) == name_key(text)
        assert name_shape(name) == name_shape(text)
        assert short(name) == name


@given(st.text())
@examples(400)
def test_any_text_can_be_looked_for_and_recorded(text: str) -> None:
    assert name_key(name_key(text)) == name_key(text)
    shown = short(text, LONGEST_NAME)
    assert len(shown) == min(len(text), LONGEST_NAME)
    shown.encode()


def test_half_a_character_can_be_looked_for_and_recorded() -> None:
    assert name_key("E\ud800va")
    assert short("E\ud800va\0") == "E\ufffdva\ufffd"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("  Eva   Lind ", "Eva Lind"),
        ("Eva\u00a0Lind", "Eva Lind"),
        ("Ｅｖａ", "Eva"),
        ("Zoe\u0308", "Zoë"),
        ("ﬁnn", "finn"),
        ("山田 太郎", "山田 太郎"),
        ("محمد", "محمد"),
        ("O'Neill-Åkesson, 2", "O'Neill-Åkesson, 2"),
    ],
)
def test_names_as_they_are_kept(text: str, name: str) -> None:
    assert clean_name(text) == name


@pytest.mark.parametrize(
    "text",
    ["", "   ", "-", "x" * 101, "ﷺ" * 99, "x" * 5000]
    + [f"E{unfit}va" for unfit in "\n\t\0\x7f\u200b\u200f\u202e\u2066\ufeff\u00ad\u2028\ue000\ufe0f\u3164\u2800\ud800"]
    + ["E\u0301\u0301\u0301\u0301va"],
)
def test_what_is_no_name(text: str) -> None:
    assert usable(text) is None


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Eva", "eva"),
        ("Eva", " EVA "),
        ("Eva", "Еva"),  # a Cyrillic letter
        ("Eva", "Evа"),
        ("Ina", "lna"),
        ("Bob", "B0b"),
        ("Zoë", "Zoe"),
        ("Eva B", "Eva B."),
        ("Eva-Lotta", "Eva Lotta"),
        ("Straße", "STRASSE"),
        ("Κατε", "Kαtε"),
    ],
)
def test_names_that_look_the_same(one: str, other: str) -> None:
    assert name_shape(clean_name(one)) == name_shape(clean_name(other)) or name_key(one) == name_key(other)


def test_names_that_do_not_look_the_same() -> None:
    names = [
        "Eva",
        "Ewa",
        "Anna",
        "Hanna",
        "Operator 1",
        "Operator 2",
        "Иван",
        "Евгений",
        "山田",
        "山本",
        "Ali",
        "Alan",
    ]
    assert len({name_shape(name) for name in names}) == len(names)
