"""The catalogue of texts: every kind of alarm has its own in every language, and each is given what it names."""

from __future__ import annotations

import ast
import pickle
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import pytest
from pydantic import TypeAdapter

import sequence_planner
from sequence_planner.controller.alarms.kinds import KINDS
from sequence_planner.texts.catalogue import TEXTS
from sequence_planner.texts.message import PLACE, Message, Wording, as_it_was, message
from support.told import PAGE, texts

SOURCE = Path(sequence_planner.__file__).parent
LANGUAGES = sorted(path.name for path in PAGE.iterdir() if path.is_dir())
OF_KIND = ("text", "past", "consequence", "action")
PHRASES = TEXTS.keys() - {f"{kind}.{what}" for kind in KINDS for what in OF_KIND}


def places(text: str) -> set[str]:
    """The names of the arguments that a text has a place for."""
    return {place[1] for place in PLACE.finditer(text)}


@cache
def all_calls() -> Mapping[str, list[ast.Call]]:
    """All calls with arguments in the program, by the name of the function or method."""
    found: dict[str, list[ast.Call]] = defaultdict(list)
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            match node:
                case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=[_, *_]):
                    found[name].append(node)
    return found


def calls(name: str) -> list[ast.Call]:
    """Calls of a function or method of the program."""
    return all_calls().get(name, [])


def ids(node: ast.expr, given: set[str | None]) -> set[str]:
    """The texts that an expression can name; where a part of the name is computed, those with the places that are
    given.
    """
    match node:
        case ast.Constant(value=str(text)):
            return {text}
        case ast.IfExp(body=body, orelse=orelse):
            return ids(body, given) | ids(orelse, given)
        case ast.JoinedStr(values=[ast.Constant(), *_] as parts):
            known = [re.escape(str(part.value)) if isinstance(part, ast.Constant) else "[A-Za-z-]+" for part in parts]
            alike = {name for name in PHRASES if re.fullmatch("".join(known), name)}
            fit = {name for name in alike if None in given or places(TEXTS[name]) == given}
            assert fit, f"no text of {ast.unparse(node)} has the places {given}"
            return fit
    return set()


# What says to people that something of theirs is wrong: calls, and the place of what they say among the arguments.
SAYING = {
    "EditError": 0,
    "ExpressionError": 0,
    "Finding": 1,
    "HistoryError": 1,
    "NoFieldError": 0,
    "TargetRefused": 0,
    "UnusableError": 0,
    "add": 1,
    "add_within": 2,
    "found": 1,
}
# Packages whose modules say it on pages, and those of them that still say so much in English alone. A number is never
# raised. Plain automata are for the command line, which is in English.
ON_PAGES = ("automaton", "editor", "history", "language", "mes", "mimic", "model", "pipelines")
IN_ENGLISH = {
    "automaton.plain.meaning": 5,
    "automaton.plain.variables": 5,
    "editor.draft": 1,
    "editor.folds.finder": 4,
    "editor.model_graph": 1,
    "editor.pipelines.examples": 9,
    "editor.pipelines.suggestions": 4,
    "editor.symbols.index": 1,
    "editor.symbols.rename": 19,
    "mimic.drawn": 12,
    "mimic.instructions": 1,
    "mimic.svg": 3,
    "model.efa_document": 1,
    "pipelines.examples": 1,
}


def is_written(node: ast.expr, known: Mapping[str, list[ast.expr]]) -> bool:
    """Whether an expression, of names that are `known` by what is assigned to them, is a string written there."""
    match node:
        case ast.Constant(value=str()) | ast.JoinedStr():
            return True
        case ast.BinOp(left=one, right=other) | ast.IfExp(body=one, orelse=other):
            return is_written(one, known) or is_written(other, known)
        case ast.Name(id=name):
            return any(is_written(each, {}) for each in known.get(name, ()))
    return False


def in_english(function: ast.FunctionDef | ast.AsyncFunctionDef) -> Iterator[str]:
    """What a function says to people in a string of its own."""
    known: dict[str, list[ast.expr]] = defaultdict(list)
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            known[node.targets[0].id].append(node.value)
    for node in ast.walk(function):
        match node:
            case ast.Call(func=ast.Attribute(attr="add", value=owner)) if "findings" not in ast.unparse(owner):
                pass
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=args) if name in SAYING:
                place = SAYING[name]
                if len(args) > place and is_written(args[place], known):
                    yield ast.unparse(node)


def test_what_is_wrong_is_said_in_every_language() -> None:
    for package in ON_PAGES:
        for path in (SOURCE / package).rglob("*.py"):
            name = ".".join(path.relative_to(SOURCE).with_suffix("").parts)
            tree = ast.parse(path.read_text(encoding="utf-8"))
            functions = [each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)]
            said = {each for function in functions for each in in_english(function)}
            assert len(said) <= IN_ENGLISH.get(name, 0), (name, said)


def test_what_a_validator_complains_of_is_said_in_every_language() -> None:
    """What a document must be like beside the types of its fields."""
    for path in (SOURCE / "model").rglob("*.py"):
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(function, ast.FunctionDef) and any(
                "validator" in ast.unparse(each) for each in function.decorator_list
            ):
                raised = [
                    ast.unparse(node)
                    for node in ast.walk(function)
                    if isinstance(node, ast.Call) and ast.unparse(node.func) == "ValueError"
                    if is_written(node.args[0], {})
                ]
                assert not raised, path.name


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_kind_has_its_texts(language: str) -> None:
    said = texts(language)
    assert not {f"{kind}.{what}" for kind in KINDS for what in OF_KIND} - said.keys()
    assert said.keys() == TEXTS.keys()
    assert all(text.strip() for text in said.values())


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_text_names_no_argument_that_is_not_there(language: str) -> None:
    assert not {name: more for name, text in texts(language).items() if (more := places(text) - places(TEXTS[name]))}


def test_the_page_has_the_english_of_the_controller() -> None:
    assert texts("en") == TEXTS, "make types"


def test_every_refusal_has_a_title() -> None:
    slugs = set()
    for name, place in {"CommandRefused": 0, "IdentityRefused": 0, "OrderRefused": 0, "ProblemFound": 1}.items():
        for call in calls(name):
            if all(keyword.arg != "title" for keyword in call.keywords) and isinstance(call.args[place], ast.Constant):
                slugs.add(ast.unparse(call.args[place]).strip("'"))
    assert len(slugs) > 100, "calls are found"
    assert {f"refused.{slug}" for slug in slugs} <= TEXTS.keys()


def test_no_refusal_is_left_over() -> None:
    source = "".join(path.read_text(encoding="utf-8") for path in SOURCE.rglob("*.py") if path.parent.name != "texts")
    known = set(re.findall(r"[\"`]([a-z]+(?:-[a-z]+)+|preparing|busy|disabled|demonstration)[\"`]", source))
    unused = [
        name
        for name in TEXTS
        if name.startswith("refused.")
        and name not in source
        and name.rpartition(".")[0] + ".{" not in source
        and name.removeprefix("refused.") not in known
    ]
    assert not unused


def test_messages_are_given_what_their_texts_name() -> None:
    seen = set()
    for call in calls("message"):
        given: set[str | None] = {keyword.arg for keyword in call.keywords}
        for name in ids(call.args[0], given):
            seen.add(name)
            if None not in given:
                assert given == places(TEXTS[name]), ast.unparse(call)
    assert len(seen) > len(TEXTS) / 3, "calls are found"


def test_causes_are_given_what_the_texts_of_their_kind_name() -> None:
    kinds = {kind.name.upper().replace("-", "_"): kind for kind in KINDS.values()}
    raised = set()
    for call in calls("cause"):
        match call:
            case ast.Call(func=ast.Attribute(value=ast.Name(id=name)), args=[_, ast.Dict(keys=keys)]) if name in kinds:
                kind = kinds[name].name
                raised.add(kind)
                wanted = {each for what in OF_KIND for each in places(TEXTS[f"{kind}.{what}"])}
                assert {key.value for key in keys if isinstance(key, ast.Constant)} >= wanted, ast.unparse(call)
    assert KINDS.keys() - raised <= {"many-silent", "never-heard", "left-out", "undecided"}, (
        "made of several kinds at once"
    )


def test_what_was_written_down_as_a_string_is_told_again_as_what_it_said() -> None:
    late = message("late.tried", late=message("late.begun", seconds=2.0), times=3)
    assert str(late) == "has not begun within 2 s, tried 3 times"
    told = as_it_was(str(late), "late.")
    assert (told.id, told.arguments["times"], told) == (late.id, 3, late)
    assert isinstance(told.arguments["late"], Message)
    assert told.arguments["late"].id == "late.begun"
    assert as_it_was("re-planned: a better way was found", "plan.").id == "plan.better"
    assert as_it_was("it was dark", "plan.") == message("as-it-was", text="it was dark")


def test_each_text_is_written_down_so_that_it_is_known_again() -> None:
    for beginning in ("plan.", "ended.", "waits."):
        for name in (each for each in PHRASES if each.startswith(beginning) and PLACE.search(TEXTS[each]) is None):
            assert as_it_was(TEXTS[name], beginning).id == name


def test_a_message_is_a_string_that_other_processes_understand() -> None:
    said = message("silent.many", count=2, resource=message("quoted", title=Wording({"en": "Arm"})))
    assert f"{said}." == "Nothing is heard on 2 topics of “Arm”."
    again = pickle.loads(pickle.dumps(said))
    assert (again, again.id, again.arguments) == (said, said.id, said.arguments)
    kept = TypeAdapter(Message)
    assert kept.validate_json(kept.dump_json(said)).sent() == said.sent()


def test_a_message_reads_as_its_language_has_it() -> None:
    waiting = message("wait.operations", operations=[message("quoted", title="Paint")], what="")
    assert str(message("wait.standstill", waiting=waiting)) == "Nothing is started. “Paint” waits."
    several = Message("wait.operations", {"operations": ["a", "b", "c", "d", "e"], "what": ""})
    assert str(several) == "a, b, c and 2 more wait."
    assert str(Wording({"sv": "Låg", "en": "Low"})) == "Low"
    assert str(Wording({"sv": "Låg"})) == "Låg"


def test_a_sentence_begins_with_a_capital_letter() -> None:
    late = message("work.late", seconds="5")
    assert message("refused.edit-refused.why", why=late) == "There was no answer within 5 s."
    assert message("refused.edit-refused.why", why="`x` is there") == "`x` is there."
