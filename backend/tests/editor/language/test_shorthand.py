"""What is written for short is completed, checked and explained where it is written."""

from __future__ import annotations

import pytest

from sequence_planner.editor.language.completion import complete
from sequence_planner.editor.language.field import TextField
from sequence_planner.editor.language.hover import Hover, hover
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.service import check
from sequence_planner.model.yaml.reader import EntryPath

from .drafts import draft

STATION, ARM = "station.yaml", "resources/arm.yaml"
MOVE: EntryPath = ("abilities", "move", "enabled")
DO: EntryPath = ("abilities", "move", "start", "do", 0)


def field(file: str, path: EntryPath) -> TextField:
    found = draft("shorthand").lexicon.field(file, path)
    assert found is not None
    return found


def inserts(marked: str, file: str = ARM, path: EntryPath = MOVE) -> list[str]:
    before, _, behind = marked.partition("|")
    found = complete(draft("shorthand").lexicon, field(file, path), before + behind, len(before))
    return [option.insert for option in found.options]


def hovered(marked: str, file: str = ARM, path: EntryPath = MOVE) -> Hover:
    before, _, behind = marked.partition("|")
    found = hover(draft("shorthand").lexicon, field(file, path), before + behind, len(before))
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("text", "offered", "others"),
    [
        ("|", {"is_free", "is_at(to)", "is_at(home)", "near(", "all_tight", "all", "at least", "count"}, {":", "in"}),
        ("all |", {"f in free", "p in part"}, {"and", "held", "near("}),
        ("all pose|", {"pose in free"}, {"held"}),
        ("all p in |", {"part", "ends", "sides", "{"}, {"held", "p1", "arm.sides"}),
        ("all si|", {"si in sides"}, {"held"}),
        ("any s in sides: side == |", {"s", "left"}, {"p1"}),
        ("at in s|", {"sides", "spot"}, {"arm.sides"}),
        ("all p in {p1, |", {"p2", "p3"}, {"home", "p1"}),
        ("all p in part |", {":", "where", ","}, {"and"}),
        ("all p in part where p |", {"<", "!=", "in"}, {"and"}),
        ("all p in part: bolts[|", {"bolts[p]", "bolts[previous(", "bolts[chosen]"}, {"bolts[held]"}),
        ("all p in part: bolts[p] == |", {"tight", "after_state[empty]"}, {"p", "p1", "home"}),
        ("(all p in part: bolts[p] == tight) and bolts[|", {"bolts[chosen]"}, {"bolts[p]"}),
        ("bolts[chosen] == tight and held |", {"==", "in"}, {"<"}),
        ("held == grip_for[|", {"grip_for[chosen]", "grip_for[p1]"}, set()),
        ("near(|", {"near(at,", "near(to,", "near(home,"}, {"near(chosen,"}),
        ("at |", {"==", "in", "least", "most"}, set()),
        ("exactly |", {"1", "2"}, set()),
    ],
)
def test_what_is_offered(text: str, offered: set[str], others: set[str]) -> None:
    found = set(inserts(text))
    assert offered <= found
    assert not others & found


def test_an_action_for_each_value() -> None:
    assert inserts("|", path=DO)[-1] == "all"
    assert {"bolts[p1]", "target"} <= set(inserts("all p in part where p < p3: |", path=DO))
    assert "bolts[p]" in inserts("all p in part: bolts[|", path=DO)


@pytest.mark.parametrize(
    ("path", "offered", "right", "wrong", "message"),
    [
        (("sets", "free", "of"), "spot", "spot", "sport", "unknown enumeration or set `sport`; did you mean `spot`?"),
        (("sets", "free", "values", 0), "home", "work", "homes", "is no value of {home, left, right, out} and no set"),
        (("sets", "work", "except", 0), "free", "free", "nowhere", "`nowhere` is no value of"),
        (("relations", "near", "between", 1), "free", "spot", "spots", "unknown enumeration or set `spots`"),
        (("relations", "fits", "pairs", 0, 1, 0), "placed", "tight", "home", "`home` is no value of"),
        (("relations", "near", "pairs", 0, 1), "work", "out", "p1", "`p1` is no value of"),
        (("maps", "grip_for", "from"), "part", "part", "parts", "unknown enumeration or set `parts`"),
        (("maps", "grip_for", "to"), "grip", "grip", "gripp", "unknown type `gripp`"),
        (("maps", "grip_for", "values", "p2"), "small", "bare", "p1", "`p1` is not in {bare, big, small}"),
        (("maps", "after_state", "otherwise"), "tight", "empty", "p1", "`p1` is not in {empty, placed, tight}"),
        (("enumerations", "pose", "includes", 0), "part", "spot", "pose", "`pose` would include itself"),
        (("predicates", "is_done", "parameters", "which"), "ends", "part", "parts", "unknown enumeration `parts`"),
        (("predicates", "is_done", "when"), "which", "all_tight", "bolts[p9] == tight", "unknown variable `bolts[p9]`"),
        (("predicates", "all_tight"), "is_done(", "is_done(p1)", "is_done", "`is_done` has 1 argument (which)"),
    ],
)
def test_each_field(path: EntryPath, offered: str, right: str, wrong: str, message: str) -> None:
    lexicon, there = draft("shorthand").lexicon, field(STATION, path)
    assert offered in inserts("|", STATION, path)
    assert check(lexicon, there, right) == ()
    [problem] = check(lexicon, there, wrong)
    assert message in problem.message


def test_the_field_of_a_new_one_is_there() -> None:
    for path in (
        ("sets", "new", "values", 0),
        ("relations", "new", "pairs", 0, 0),
        ("maps", "new", "values", "p1"),
        ("predicates", "new"),
    ):
        assert draft("shorthand").lexicon.field(STATION, path) is not None
    assert "held" in inserts("|", ARM, ("predicates", "new", "when"))


@pytest.mark.parametrize(
    ("text", "kind", "pattern", "part", "expansion"),
    [
        ("is_f|ree", NameKind.PREDICATE, "arm.is_free", "predicate:arm.is_free",
         "arm.at in {home, out} and not (arm.at == left and arm.target == left)"),
        ("is|_at(home)", NameKind.PREDICATE, "arm.is_at(home)", "predicate:arm.is_at",
         "arm.at == home and arm.target == home"),
        ("is|_at(to)", NameKind.PREDICATE, "arm.is_at(to)", "predicate:arm.is_at",
         "to = home: arm.at == home and arm.target == home"),
        ("fi|ts(held, placed)", NameKind.RELATION, "fits(held, placed)", "relation:fits", "big – placed, big – tight"),
        ("held == grip_|for[p1]", NameKind.MAP, "grip_for[p1]", "map:grip_for", "p2 → big, p1 → small, p3 → small"),
        ("at in fr|ee", NameKind.SET, "free", "set:free", None),
        ("a|ll p in ends: bolts[p] == tight", NameKind.KEYWORD, "all", None,
         "bolts[p1] == tight and bolts[p3] == tight"),
        ("all p| in ends: bolts[p] == tight", NameKind.PARAMETER, "p", None, None),
        ("all p in en|ds: bolts[p] == tight", NameKind.SET, "ends", "set:ends", None),
        ("all p in ends: bolts[|p] == tight", NameKind.PARAMETER, "p", None, None),
        ("all p in ends: bo|lts[previous(p)] == tight", NameKind.ESTIMATED, "bolts[previous(p)]", "variable:bolts",
         None),
    ],
)  # fmt: skip
def test_what_a_name_stands_for(
    text: str, kind: NameKind, pattern: str, part: str | None, expansion: str | None
) -> None:
    found = hovered(text)
    assert (found.kind, found.pattern, found.part, found.expansion) == (kind, pattern, part, expansion)
    assert (found.place is not None) is (part is not None)


def test_a_long_expansion_is_cut_off() -> None:
    found = hovered("a|ny p, q in part, r in ends: bolts[p] == bolts[q] and bolts[r] == tight")
    assert found.expansion is not None
    assert len(found.expansion) < 420
    assert found.expansion.endswith(" …")


def test_a_set_of_a_resource_is_explained_by_either_name() -> None:
    for text, written in (("at in si|des", "sides"), ("any s in arm.si|des: side == s", "arm.sides")):
        found = hovered(text)
        assert (found.kind, found.pattern, found.part) == (NameKind.SET, "arm.sides", "set:arm.sides"), written
        assert found.place is not None
        assert found.place.file == ARM
    assert "arm.sides" in inserts("arm.at in |", "specifications.yaml", ("apart", "never"))
