"""What an outline becomes can be used as it is, whatever people call things; what cannot is told with its place."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.outline.beginning import outlined, templates
from sequence_planner.editor.outline.facts import is_on_the_way, is_so_at_first
from sequence_planner.editor.outline.outline import (
    Clamp,
    Fact,
    Never,
    Outline,
    OutlineItem,
    OutlineStep,
    PersonDevice,
    Pose,
    Product,
    Robot,
    Stand,
    Tool,
)
from sequence_planner.editor.outline.writing import spoken
from support.commands import as_json, command
from support.examples import examples

# With what YAML takes for something else; braces are told as a problem.
TITLES = st.one_of(
    st.sampled_from(
        ["", "no", "1.5", "a: b", "- x", "#1", "“så”", "it's", '"', "{", "null", "ready, set", "\\n", "%s"]
    ),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=12),
)
# Surrogates are in no JSON that is sent.
SOUND = TITLES.filter(lambda title: "{" not in title and "}" not in title)


@st.composite
def outlines(draw: st.DrawFn) -> Outline:
    """Outlines that are finished."""
    joints = draw(st.integers(0, 3))

    def robot(name: str) -> Robot:
        called = draw(st.lists(SOUND, min_size=1, max_size=4, unique_by=spoken))
        poses = [
            Pose(name=f"p{at}", title=title, joints=tuple(at + 0.1 * each for each in range(joints)))
            for at, title in enumerate(called)
        ]
        return Robot(name=name, title=draw(SOUND), poses=tuple(poses), ways=draw(st.sampled_from(["any", "row"])))

    robots = [robot(f"robot_{at}") for at in range(draw(st.integers(0, 2)))]
    able = draw(
        st.lists(st.sampled_from([Tool, Clamp, PersonDevice]), min_size=1, max_size=3).map(
            lambda kinds: [kind(name=f"{kind.__name__.lower()}_{at}") for at, kind in enumerate(kinds)]
        )
    )
    called = draw(st.lists(SOUND, min_size=2, max_size=4, unique_by=spoken))
    states = [OutlineItem(name=f"state_{at}", title=title) for at, title in enumerate(called)]
    steps, closed = list[OutlineStep](), dict[str, bool]()
    for at in range(len(states) - 1):
        by = draw(st.sampled_from(able))
        where = [Stand(robot=each.name, pose=draw(st.sampled_from(each.poses)).name) for each in robots]
        action: Literal["open", "close"] | None = None
        if isinstance(by, Clamp):
            action = "open" if closed.get(by.name) else "close"
            closed[by.name] = action == "close"
        stands = tuple(where if draw(st.booleans()) else ())
        name, title = f"step_{at}", draw(SOUND)
        steps.append(OutlineStep(name=name, title=title, by=by.name, action=action, where=stands))
    for name in (each for each, is_closed in closed.items() if is_closed):
        states.append(OutlineItem(name=f"{name}_opened", title=f"{name} opened"))
        steps.append(OutlineStep(name=f"open_{name}", by=name, action="open"))
    product = Product(
        name="part",
        title=draw(SOUND),
        states=tuple(states),
        steps=tuple(steps),
        then=draw(st.sampled_from(["next", "order", "once"])),
    )
    outline = Outline(title=draw(SOUND), devices=(*robots, *able), product=product)
    things = outlined(outline, "made").things

    def facts(least: int) -> tuple[Fact, ...]:
        chosen = draw(st.lists(st.sampled_from(things), min_size=least, max_size=2))
        return tuple(
            Fact(thing=each.id, value=draw(st.sampled_from(sorted(each.values))), holds=draw(st.booleans()))
            for each in chosen
        )

    never = [Never(title=draw(SOUND), facts=facts(1), during=facts(0)) for _ in range(draw(st.integers(0, 2)))]
    said = [(each, (*each.facts, *each.during)) for each in never]
    sound = [each for each, facts in said if not is_so_at_first(facts, outline) and not is_on_the_way(facts, outline)]
    return outline.model_copy(update={"never": tuple(sound)})


@examples(200)
@given(outlines())
def test_a_finished_outline_becomes_documents_that_can_be_used(outline: Outline) -> None:
    view = outlined(outline, "made")
    assert view.problems == []
    with TemporaryDirectory() as folder:
        draft = LanguageDraft(Path(folder) / "made")
        draft.take(view.files)
        assert draft.errors() == []
        assert draft.meant_last is not None
        automaton = draft.meant_last.automaton
        steps = {f"{each.by}.{each.name}" for each in outline.product.steps}
        assert steps <= automaton.abilities.keys()
        assert len(automaton.operations) == len(steps) + (outline.product.then == "next")
        assert len(automaton.specifications) == len(outline.never)


def test_every_thing_that_has_a_name_is_told_by_its_title_where_it_has_one() -> None:
    """A title that cannot be one of YAML as it stands is put into quotes, and is the same again."""
    outline = templates().templates["bolt"]
    product = outline.product
    titled = outline.model_copy(
        update={"title": "yes: 100 % “så” #1", "product": product.model_copy(update={"title": "1.5"})}
    )
    with TemporaryDirectory() as folder:
        draft = LanguageDraft(Path(folder) / "made")
        draft.take(outlined(titled, "made").files)
        assert draft.errors() == []
        assert draft.meant_last is not None
        assert str(draft.meant_last.automaton.title) == "yes: 100 % “så” #1"


def broken(**changes: object) -> list[tuple[list[str | int], str]]:
    """Problems of the template with a bolt where something is otherwise, each with its place."""
    data: dict[str, Any] = templates().templates["bolt"].model_dump()
    for path, value in changes.items():
        *way, last = path.split("__")
        at: Any = data
        for each in way:
            at = at[int(each)] if each.isdigit() else at[each]
        at[int(last) if last.isdigit() else last] = value
    view = outlined(Outline.model_validate(data), "made")
    assert (view.files == {}) == (view.problems != [])
    return [(each.place, each.why) for each in view.problems]


@pytest.mark.parametrize(
    ("changes", "place", "why"),
    [
        ({"devices": []}, ["devices"], "add a device"),
        ({"devices__1__name": "operator"}, ["devices", 1, "name"], "is called `operator` already"),
        ({"devices__1__name": "a b"}, ["devices", 1, "name"], "is no name"),
        ({"devices__1__name": "bolt"}, ["devices", 1, "name"], "already"),
        ({"product__states__1__title": "tight"}, ["product", "states", 2, "title"], "called “tight” already"),
        ({"devices__1__title": "{x}"}, ["devices", 1, "title"], "braces"),
        ({"product__name": "request"}, ["product", "name"], "is called `request` already"),
        ({"product__steps__0__name": "next_bolt"}, ["product", "steps", 0, "name"], "is called `next_bolt` already"),
        ({"devices__2__kind": "clamp"}, ["product", "steps", 1, "action"], "opens or closes"),
        (
            {"devices__2__kind": "clamp", "product__steps__1__action": "close"},
            ["product", "steps", 1, "action"],
            "nothing opens Nutrunner after this",
        ),
        (
            {"devices__2__kind": "clamp", "product__steps__1__action": "open"},
            ["product", "steps", 1, "action"],
            "is open then",
        ),
        (
            {"never__0__facts": [{"thing": "bolt", "value": "tight"}], "never__0__during": []},
            ["never", 0],
            "comes through this",
        ),
        ({"devices__1__poses": []}, ["devices", 1, "poses"], "no poses"),
        ({"devices__1__poses__2__joints": [1.0]}, ["devices", 1, "poses", 2, "joints"], "has 6 joints, this one has 1"),
        ({"devices__1__poses__2__name": "between"}, ["devices", 1, "poses", 2, "name"], "already"),
        (
            {"devices__1__poses__2__joints": [0.0, -1.57, 1.57, -1.57, -1.57, 0.01]},
            ["devices", 1, "poses", 2, "joints"],
            "cannot be told from home",
        ),
        (
            {"product__states": [{"name": "one"}], "product__steps": []},
            ["product", "states"],
            "a first state and a last",
        ),
        ({"product__steps": []}, ["product", "steps"], "3 states"),
        ({"product__steps__1__by": "robot"}, ["product", "steps", 1, "by"], "nobody does this"),
        ({"product__steps__1__by": "gone"}, ["product", "steps", 1, "by"], "nobody does this"),
        (
            {"product__steps__1__where": [{"robot": "robot", "pose": "x"}]},
            ["product", "steps", 1, "where", 0, "pose"],
            "no such pose",
        ),
        (
            {"product__steps__1__where": [{"robot": "nutrunner", "pose": "x"}]},
            ["product", "steps", 1, "where", 0, "robot"],
            "no such robot",
        ),
        ({"never__0__facts": []}, ["never", 0, "facts"], "say what must never be"),
        (
            {"never__0__facts": [{"thing": "bolt", "value": "missing"}], "never__0__during": []},
            ["never", 0],
            "at the beginning",
        ),
        (
            {"never__0__facts": [{"thing": "gone", "value": "x"}]},
            ["never", 0, "facts", 0, "thing"],
            "not there any more",
        ),
        ({"never__0__during": [{"thing": "bolt", "value": "x"}]}, ["never", 0, "during", 0, "value"], "no such value"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(changes: dict[str, object], place: list[str | int], why: str) -> None:
    found = broken(**changes)
    assert any(each == place and why in said for each, said in found), found


WORDS = [
    "request",
    "place",
    "run",
    "bolt",
    "next",
    "supply",
    "home",
    "open",
    "close",
    "part",
    "x",
    "nothing",
    "between",
]
NAMES = st.sampled_from(
    [*WORDS, "next_part", "part_state", "station", "true", "pose", "stop", "operator", "mode", "order"]
)


@examples(300)
@given(st.data())
def test_names_that_are_taken_make_documents_that_can_be_used(data: st.DataObject) -> None:
    """What the documents call things themselves is told at the name that would be in its way."""
    one, other, product, first, last, step, pose = (data.draw(NAMES) for _ in range(7))
    robot = Robot(name=one, poses=(Pose(name=pose),))
    kind = data.draw(st.sampled_from([Tool, PersonDevice]))
    outline = Outline(
        devices=(robot, kind(name=other)),
        product=Product(
            name=product,
            states=(OutlineItem(name=first), OutlineItem(name=last)),
            steps=(OutlineStep(name=step, by=other, where=(Stand(robot=one, pose=pose),)),),
        ),
    )
    view = outlined(outline, "made")
    if not view.problems:
        with TemporaryDirectory() as folder:
            draft = LanguageDraft(Path(folder) / "made")
            draft.take(view.files)
            assert draft.errors() == []


@examples(200)
@given(st.from_type(Outline))
def test_whatever_is_not_finished_is_told_and_nothing_is_made_of_it(outline: Outline) -> None:
    view = outlined(outline, "made")
    assert (view.files == {}) == (view.problems != [])


@pytest.mark.parametrize("name", sorted(templates().templates))
def test_a_template_says_the_same_in_another_language(name: str) -> None:
    """Each title is in the other words, but for those that are the same; names stay."""
    english, swedish = templates().templates[name], templates("sv").templates[name]
    assert outlined(swedish, "made").problems == []
    assert english.model_dump(exclude={"title"}) != swedish.model_dump(exclude={"title"})

    def items(part: object, key: str) -> list[object]:
        if isinstance(part, dict):
            return [*filter(None, [part.get(key)]), *(each for value in part.values() for each in items(value, key))]
        return [each for value in part for each in items(value, key)] if isinstance(part, list | tuple) else []

    assert items(english.model_dump(), "name") == items(swedish.model_dump(), "name")
    pairs = zip(items(english.model_dump(), "title"), items(swedish.model_dump(), "title"), strict=True)
    assert [each for each, other in pairs if each == other] in ([], ["Robot"])


@pytest.mark.parametrize("name", sorted(templates().templates))
def test_a_template_is_checked_without_findings_and_makes_its_product(name: str, tmp_path: Path) -> None:
    for path, text in outlined(templates().templates[name], "made").files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    code, out, err = command("check", tmp_path)
    assert (code, err) == (0, ""), out
    code, told = as_json("test", tmp_path)
    assert code == 0
    assert [each["passed"] for each in told["scenarios"]] == [True]
    assert told["not_exercised"]["operations"] == []
