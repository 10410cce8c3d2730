"""A picture drawn by hand: what `mimic.yaml` binds is looked up, what is not there is told, and the rest is drawn."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import PurePath
from typing import Final

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.findings import Findings, without_arguments
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import IntegerRange, Value
from sequence_planner.mimic.motion import motions
from sequence_planner.mimic.parts import MOST_PARTS, label_place, labels_of, looks_of, text_of_value, titles_of
from sequence_planner.mimic.svg import TEXTS, drawing_of
from sequence_planner.mimic.views import (
    Box,
    MimicBound,
    MimicDrawing,
    MimicFinding,
    MimicLevel,
    MimicPart,
    MimicSlot,
    MimicStop,
    MimicSymbol,
    MimicTest,
    MimicText,
    MimicTrack,
    MimicView,
)
from sequence_planner.model.fields import Words, words_of
from sequence_planner.model.mimic.documents import (
    BindDocument,
    MimicDocument,
    PartDocument,
    SlotDocument,
    SymbolDocument,
    TrackDocument,
    Values,
)
from sequence_planner.model.source import SourceText

_MOST_ELEMENTS: Final = 20_000
_PLACEHOLDER = re.compile(r"\{([^{}]*)\}")


def drawn(
    automaton: Automaton, document: MimicDocument, drawings: Mapping[str, SourceText], findings: Findings
) -> MimicView:
    """The picture of `document`, with the texts of its own `drawings`; what it binds that is not there is noted in
    `findings` and left out.
    """
    drawing = _Drawing(automaton, document, drawings, findings)
    symbols = [drawing.symbol(name, each) for name, each in document.symbols.items()]
    width, height = document.size
    return MimicView(made_from="file", width=width, height=height, symbols=symbols, findings=as_shown(findings))


def as_shown(findings: Findings) -> list[MimicFinding]:
    """The findings as they are shown: files by their names in the station's folder, wherever that is."""
    return [
        MimicFinding(
            file=_within(each.place.file), line=each.place.line, column=each.place.column, message=each.message
        )
        for each in sorted(set(findings.all))
    ]


def _within(file: str) -> str:
    path = PurePath(file)
    return f"drawings/{path.name}" if path.parent.name == "drawings" else path.name


class _Drawing:
    def __init__(
        self, automaton: Automaton, document: MimicDocument, drawings: Mapping[str, SourceText], findings: Findings
    ) -> None:
        self._automaton, self._findings = automaton, findings
        self._texts = drawings
        self._drawings: dict[str, MimicDrawing | None] = {}
        self._elements = 0
        self._size = document.size
        self._families: dict[str, list[str]] = {}
        for name in automaton.variables:
            self._families.setdefault(without_arguments(name), []).append(name)

    def symbol(self, name: SourceText, document: SymbolDocument) -> MimicSymbol:
        """A thing, with all that it binds and that is there."""
        resource = document.resource
        if resource is not None and not self._known(resource, self._automaton.resources, "resource"):
            resource = None
        box = _box(document.at, document.size)
        if min(box.x, box.y) < 0 or box.x + box.width > self._size[0] or box.y + box.height > self._size[1]:
            width, height = self._size
            self._findings.add(name, f"`{name}` lies outside the drawing, which is {width:g} wide and {height:g} high")
        return MimicSymbol(
            name=str(name),
            symbol=document.symbol,
            resource=None if resource is None else str(resource),
            title=dict(words_of(document.title)) or ({"": name.replace("_", " ")} if resource is None else {}),
            box=box,
            texts=[
                MimicText(text=self._text(each.say), when=tests)
                for each in document.text
                if (tests := self._tests(each.when)) is not None
            ],
            active=self._tests(document.active) or [],
            visible=self._tests(document.visible) or [],
            level=None if document.level is None else self._level(document.level),
            drawing=self._own(document.drawing, document.bind),
            track=None if document.track is None else self._track(document.track),
            slots=[slot for each in document.slots if (slot := self._slot(each)) is not None],
            parts=[part for each in document.parts for part in self._parts(each)],
        )

    # Names and values.

    def _known(self, name: SourceText, among: Collection[str], what: str) -> bool:
        if name in among:
            return True
        self._findings.add(name, f"there is no {what} `{name}`{suggestion(name, among)}")
        return False

    def _variable(self, name: SourceText) -> str | None:
        return str(name) if self._known(name, self._automaton.variables, "variable") else None

    def _value(self, variable: str, value: Value, near: SourceText) -> Value | None:
        """The value, where the variable can have it; None where it never has."""
        domain = self._automaton.variables[variable].type.domain
        plain = str(value) if isinstance(value, str) else value
        if any(each == plain and type(each) is type(plain) for each in domain):
            return plain
        where = value if isinstance(value, SourceText) else near
        shown = text_of_value(value)
        self._findings.add(
            where, f"`{variable}` is never `{shown}`{suggestion(shown, list(map(text_of_value, domain)))}"
        )
        return None

    def _tests(self, values: Values) -> list[MimicTest] | None:
        """The tests; None where one of them asks for what is not there."""
        tests: list[MimicTest] = []
        is_whole = True
        for name, wanted in values.items():
            variable = self._variable(name)
            if variable is None:
                is_whole = False
                continue
            found = [self._value(variable, each, name) for each in (wanted if isinstance(wanted, list) else [wanted])]
            is_whole = is_whole and None not in found
            tests.append(MimicTest(variable=variable, values=[each for each in found if each is not None]))
        return tests if is_whole else None

    def _text(self, words: Words) -> dict[str, str]:
        """The text by language; the variables in it are looked up."""
        said = [words] if isinstance(words, SourceText) else [words.en, words.sv]
        for each in said:
            for found in _PLACEHOLDER.finditer(each or ""):
                assert each is not None
                if found[1] not in self._automaton.variables:
                    near = suggestion(found[1], self._automaton.variables)
                    self._findings.add(each, f"there is no variable `{found[1]}`{near}")
        return dict(words_of(words))

    # Parts of a symbol.

    def _level(self, name: SourceText) -> MimicLevel | None:
        variable = self._variable(name)
        if variable is None:
            return None
        of = self._automaton.variables[variable].type
        if not isinstance(of, IntegerRange):
            self._findings.add(name, f"a level shows a number, and `{name}` is {of}")
            return None
        return MimicLevel(variable=variable, lowest=of.minimum, highest=of.maximum)

    def _track(self, document: TrackDocument) -> MimicTrack | None:
        position = self._variable(document.of)
        others = [None if name is None else self._variable(name) for name in (document.to, document.previous)]
        if position is None:
            return None
        titles = titles_of(self._automaton, position)
        stops = [
            MimicStop(
                value=str(value),
                title=dict(words_of(stop.title)) or titles.get(str(value), {}),
                x=stop.at[0],
                y=stop.at[1],
                label=stop.label,
                room=stop.room,
                branch=stop.branch,
            )
            for value, stop in document.stops.items()
            if self._value(position, value, value) is not None
        ]
        names = {each.value for each in stops}
        if document.ways is None:
            every = [way for each in motions(self._automaton) if each.position == position for way in each.ways]
            ways = [(start, end) for start, end in every if start in names and end in names]
        else:
            ways = [
                (str(start), str(end))
                for start, end in document.ways
                if all(self._known(each, names, "stop") for each in (start, end))
            ]
        return MimicTrack(position=position, target=others[0], previous=others[1], stops=stops, ways=ways)

    def _slot(self, document: SlotDocument) -> MimicSlot | None:
        holds = self._tests(document.holds)
        if holds is None:
            return None
        return MimicSlot(
            box=_box(document.at, document.size),
            title=dict(words_of(document.title)),
            symbol=document.symbol,
            drawing=self._own(document.drawing, {}),
            holds=holds,
        )

    # Drawings of the station's own.

    def _own(self, file: SourceText | None, binds: Mapping[SourceText, BindDocument]) -> MimicDrawing | None:
        """A drawing, with what its elements follow."""
        if file is None:
            for each in binds:
                self._findings.add(each, "there is no `drawing` here whose elements could follow something")
            return None
        if not self._known(file, self._texts, "file"):
            return None
        name = str(file)
        if name not in self._drawings:
            text = self._texts[name]
            self._drawings[name] = drawing_of(text, text.place.file, self._findings)
        drawing = self._drawings[name]
        if drawing is None:
            return None
        self._elements += len(drawing.elements)
        if self._elements > _MOST_ELEMENTS:
            self._findings.add(file, f"left out: the drawings of a picture have at most {_MOST_ELEMENTS} elements")
            return None
        names = {each.attributes["id"]: each.name for each in drawing.elements if "id" in each.attributes}
        bound = [
            self._bound(str(name), names[name], bind)
            for name, bind in binds.items()
            if self._known(name, names, "element")
        ]
        return drawing.model_copy(update={"bound": bound})

    def _bound(self, name: str, element: str, bind: BindDocument) -> MimicBound:
        says = bind.text
        if says is not None and element not in TEXTS:
            said = (says,) if isinstance(says, SourceText) else (says.en, says.sv)
            near = next(each for each in said if each is not None)
            self._findings.add(near, f"`{name}` is a `{element}`, and only a `text` or `tspan` says something")
            says = None
        if bind.when and bind.role is None:
            self._findings.add(next(iter(bind.when)), "there is no `role` here that it could have then")
        tests = self._tests(bind.when)
        return MimicBound(
            element=name,
            visible=self._tests(bind.visible) or [],
            role=None if tests is None else bind.role,
            when=tests or [],
            text={} if says is None else self._text(says),
        )

    def _parts(self, document: PartDocument) -> list[MimicPart]:
        """The part; of an indexed variable one for each of its values."""
        members = self._families.get(str(document.of), [])
        if document.of in self._automaton.variables:
            members = [str(document.of)]
        if not members:
            self._findings.add(
                document.of, f"there is no variable `{document.of}`{suggestion(document.of, self._families)}"
            )
            return []
        if len(members) > MOST_PARTS:
            count = f"{MOST_PARTS} of the {len(members)}"
            self._findings.add(document.of, f"the first {count} parts are drawn: more could not be told apart")
            members = members[:MOST_PARTS]
        of = self._automaton.variables[members[0]].type
        looks = looks_of(of)
        for value, look in document.looks.items():
            if text_of_value(value) in looks:
                looks[str(value)] = look
            else:
                self._findings.add(value, f"`{document.of}` is never `{value}`{suggestion(value, looks)}")
        titles = titles_of(self._automaton, members[0])
        single = members == [str(document.of)]
        labels = [""] if single else labels_of([name[name.index("[") + 1 : -1].split(", ")[-1] for name in members])
        parts: list[MimicPart] = []
        for number, (name, label) in enumerate(zip(members, labels, strict=True)):
            column, row = number % document.columns, number // document.columns
            x = document.at[0] + column * document.step[0] + row * document.row[0]
            y = document.at[1] + column * document.step[1] + row * document.row[1]
            marks = [(x + dx, y + dy) for dx, dy in document.marks]
            label_x, label_y = label_place(marks, document.size, document.label)
            parts.append(
                MimicPart(
                    variable=name,
                    title=dict(words_of(document.title)) if single else {},
                    label=label,
                    label_x=label_x,
                    label_y=label_y,
                    marks=marks,
                    size=document.size,
                    looks=looks,
                    titles=titles,
                )
            )
        return parts


def _box(at: list[float], size: list[float]) -> Box:
    return Box(x=at[0], y=at[1], width=size[0], height=size[1])
