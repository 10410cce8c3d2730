"""Whatever is typed, there is an answer; and what the page is told of it can be read back."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.language.completion import MOST_OPTIONS, complete
from sequence_planner.editor.language.field import TextField
from sequence_planner.editor.language.hover import hover
from sequence_planner.editor.language.schemas import CompletionView, HoverView, NameKind, OptionView, ProblemView
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.language.service import check, completion_view, formatted, hover_view, problem_view
from support.examples import examples

from .drafts import draft, with_text

NAMES = ("robot", "pose", "bolts", "pair", "bolt_pair_1", "executing", "move_to_position", "home", "F", "U")
SIGNS = (":=", "==", *"<+-()[]{}.,1#é𝒳", " ", " ")
WORDS = st.sampled_from((*NAMES, *SIGNS, "and", "not", "in", "if", "true"))
TYPED = st.lists(WORDS, max_size=14).map("".join)
FIELDS = st.sampled_from(sorted({str(each): each.field for each in draft("bolt_tightening").texts}.items())[::3])


@examples(500)
@given(FIELDS, TYPED, st.data())
def test_every_question_about_any_text_is_answered(
    named: tuple[str, TextField], text: str, data: st.DataObject
) -> None:
    lexicon, field = draft("bolt_tightening").lexicon, named[1]
    offset = data.draw(st.integers(0, len(text)))
    for problem in check(lexicon, field, text):
        assert 0 <= problem.start <= problem.end <= len(text)
        view = problem_view(problem)
        assert ProblemView.model_validate_json(view.model_dump_json()) == view
    found = complete(lexicon, field, text, offset)
    assert 0 <= found.start <= offset <= found.end <= len(text)
    assert len(found.options) <= MOST_OPTIONS
    assert len({option.insert for option in found.options}) == len(found.options)
    options = completion_view(found)
    assert CompletionView.model_validate_json(options.model_dump_json()) == options
    if (hovered := hover(lexicon, field, text, offset)) is not None:
        assert hovered.start <= offset <= hovered.end
        assert text[hovered.start : hovered.end] == hovered.name or hovered.kind is NameKind.ABILITY
        shown = hover_view(hovered)
        assert HoverView.model_validate_json(shown.model_dump_json()) == shown
    assert formatted(field, formatted(field, text)) == formatted(field, text)


def test_an_option_is_shown_with_its_kind_and_type() -> None:
    lexicon = draft("bolt_tightening").lexicon
    field = lexicon.field("resources/robot.yaml", ("abilities", "move_to_position", "enabled"))
    assert field is not None
    view = completion_view(complete(lexicon, field, "mov", 3))
    assert (view.start, view.end) == (0, 3)
    assert view.options[0] == OptionView(label="moving", insert="moving", kind=NameKind.MEASURED, detail="bool")


def test_a_draft_with_unknown_message_types_keeps_what_follows_from_the_others() -> None:
    station = draft("bolt_tightening").station
    robot = station.resources["robot"]
    undeclared = {name: each for name, each in robot.measured.items() if name != "moving"}  # it follows from a message
    station = replace(
        station, resources={**station.resources, "robot": robot.model_copy(update={"measured": undeclared})}
    )
    path = ("topics", "/ur10/state", "type")
    broken, _ = with_text(station, "resources/robot.yaml", path, "truck_engine_msgs/msg/Nothing")
    lexicon = Lexicon.of(broken)
    field = lexicon.field("resources/robot.yaml", ("abilities", "move_to_previous", "enabled"))
    assert field is not None
    assert check(lexicon, field, "pose == home and nutrunner.tool_is_running_forward") == ()
    assert check(lexicon, field, "moving") != ()
