"""Instances of types checked, and the resources that are made of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pydantic import ValidationError

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.model.documents import ResourceDocument, StationDocument
from sequence_planner.model.fields import fault_of_name
from sequence_planner.model.source import Finding, SourceText, with_given_at
from sequence_planner.model.types.documents import ParameterDocument
from sequence_planner.model.types.expansion import GivenArgument
from sequence_planner.model.types.layers import (
    Layer,
    UnusedType,
    WrittenInstance,
    content_of,
    document_of,
    layers_of,
)
from sequence_planner.model.types.unused import unused_types
from sequence_planner.model.validation import findings_of, shown
from sequence_planner.texts.message import message

_WANTED = {"number": "a number", "text": "a text", "value": "a value", "resource": "a resource"}


class InstancesBefore:
    """The resources that instances were, for as long as what they and their types say is the same object."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[list[WrittenInstance], ResourceDocument | None, list[Finding]]] = {}

    def made_before(self, name: str, layers: list[Layer]) -> tuple[ResourceDocument | None, list[Finding]] | None:
        """Return what was made of these layers."""
        known = self._known.get(name)
        if known is None or len(known[0]) != len(layers):
            return None
        return known[1:] if all(a is b.written for a, b in zip(known[0], layers, strict=True)) else None

    def keep_made(self, name: str, layers: list[Layer], made: ResourceDocument | None, wrong: list[Finding]) -> None:
        """Remember that."""
        self._known[name] = [each.written for each in layers], made, wrong


class Instances:
    """The instances of a station. `types` are known by their names, those of packages as `package.name`; None is one
    of which something is wrong. `brought` are the enumerations of each package. What is found is noted in `findings`,
    and in `layers` what each instance is made of.
    """

    def __init__(
        self,
        types: Mapping[str, WrittenInstance | None],
        station: StationDocument,
        resources: Collection[str],
        before: InstancesBefore,
        brought: Mapping[str, Collection[str]],
    ) -> None:
        self._types = types
        self._station = station
        self._resources = resources
        self._before = before
        self.findings: list[Finding] = []
        self.layers: dict[str, list[Layer]] = {}
        self._enumerations = {str(name): values for name, values in station.enumeration_values().items()}
        self._ranges = [*map(str, station.enumerations), *map(str, station.sets)]
        self._brought = brought
        self._sound = {name for name, type_ in types.items() if type_ is not None and self._is_sound(type_)}

    def made_of(self, name: str, written: WrittenInstance) -> ResourceDocument | None:
        """The resource that an instance is; None after all that is wrong with it has been noted."""
        assert written.head.type is not None
        instance = f"{name} ({written.head.type.place})"
        layers, wrong, is_whole = layers_of(instance, written, self._types)
        self.layers[name] = layers
        before = len(self.findings)
        self.findings += [] if wrong is None else [wrong]
        if not is_whole or any(each.name not in self._sound for each in layers[1:]):
            return None
        for index, layer in enumerate(layers[1:]):
            self._check_arguments(instance, layer, layers[index])
        meanings = {name: layer.written for layer in layers for name in layer.written.meanings}
        for layer in layers[1:]:
            for each in layer.arguments.values():
                self._require_free(each, meanings)
        if len(self.findings) > before:
            return None
        known = self._before.made_before(name, layers)
        if known is None:
            found: list[Finding] = []
            made = _made(instance, layers, found)
            known = made, found
            self._before.keep_made(name, layers, *known)
        self.findings += known[1]
        return known[0]

    def read_unused(self) -> dict[str, UnusedType]:
        """The types that no instance has, as far as all is right with them; what is wrong with others is noted."""
        used = {layer.name for layers in self.layers.values() for layer in layers}
        unused = [name for name in self._types if name in self._sound - used]
        found, wrong = unused_types(unused, self._types) if unused else ({}, [])
        self.findings += wrong
        return found

    def _note(self, where: SourceText | Place, message: str) -> None:
        self.findings.append(Finding(where.place if isinstance(where, SourceText) else where, message))

    # What is right of a type and of what it is given.

    def _is_sound(self, type_: WrittenInstance) -> bool:
        """Check whether the parameters of a type hide nothing."""
        before = len(self.findings)
        values = self._values(self._brought.get(type_.package, ()) if type_.package else self._enumerations)
        for name, parameter in type_.parameters.items():
            if (fault := fault_of_name(name, "parameter")) is not None:
                self._note(name, fault)
            elif (hidden := type_.meanings.get(name)) is not None:
                self._note(name, f"the parameter `{name}` hides the {hidden} `{name}`: rename one of them")
            elif not type_.package and name in self._station.estimated:
                self._note(name, f"the parameter `{name}` hides the variable `{name}`: rename one of them")
            elif name in values:
                said = f"the parameter `{name}` hides the value `{name}` of `{values[name]}`: rename one of them"
                self._note(name, said)
            if parameter.of is not None and (of := type_.parameters.get(parameter.of)) is not None:
                if of.kind != "enumeration":
                    self._note(parameter.of, f"`{parameter.of}` is {_WANTED[of.kind]}, and no enumeration")
            elif parameter.of is not None and parameter.of not in self._ranges:
                near = suggestion(parameter.of, [*type_.parameters, *self._ranges])
                self._note(parameter.of, f"unknown enumeration `{parameter.of}`{near}")
        return len(self.findings) == before

    def _values(self, enumerations: Collection[str]) -> dict[str, str]:
        """The values of these enumerations, each with its own."""
        return {str(value): name for name in enumerations for value in self._enumerations.get(name, ())}

    def _check_arguments(self, instance: str, type_: Layer, by: Layer) -> None:
        """Note what is wrong with the arguments that a layer gives to a type."""
        head, parameters = by.written.head, type_.written.parameters
        assert head.type is not None
        for name in head.arguments:
            if name not in parameters:
                self._note(name, f"`{type_.name}` has no parameter `{name}`{suggestion(name, parameters)}")
        for name, parameter in parameters.items():
            if name in head.arguments:
                where = by.written.document.place_of_value(("arguments", str(name)))
            else:
                where = name.place._replace(instance=instance)
            if name in type_.arguments:
                self._check_argument(name, parameter, type_.arguments, where)
            else:
                what = f"`{type_.name}` needs the argument `{name}`, {self._expected(parameter)}"
                self._note(head.type, f"{what}: write it into `arguments`")

    def _check_argument(
        self, name: SourceText, parameter: ParameterDocument, made: Mapping[str, GivenArgument], where: Place
    ) -> None:
        given = made[str(name)]
        content = given.content
        place = content.place if isinstance(content, SourceText) else where
        is_number = not isinstance(content, SourceText)
        if given.kind != parameter.kind or is_number != (parameter.kind == "number"):
            found = shown(content) if given.kind == parameter.kind else f"`{given.text}`, {_WANTED.get(given.kind)}"
            quotes = ": put it into quotes" if is_number and parameter.kind == "text" else ""
            self._note(place, f"expected {self._expected(parameter)} for `{name}`, found {found}{quotes}")
        elif parameter.kind == "enumeration" and content not in self._ranges:
            self._note(place, f"unknown enumeration `{content}`{suggestion(given.text, self._ranges)}")
        elif parameter.kind == "resource" and content not in self._resources:
            self._note(place, f"unknown resource `{content}`{suggestion(given.text, self._resources)}")
        elif parameter.kind == "value":
            assert parameter.of is not None
            of = made[parameter.of].text if parameter.of in made else str(parameter.of)
            values = self._enumerations.get(of)
            if values is not None and content not in values:
                near = suggestion(given.text, values)
                self._note(place, f"`{content}` is no value of `{of}`, and `{name}` is one{near}")

    @staticmethod
    def _expected(parameter: ParameterDocument) -> str:
        if parameter.kind == "value":
            return f"a value of `{parameter.of}`"
        return _WANTED.get(parameter.kind, "an enumeration")

    def _require_free(self, given: GivenArgument, meanings: Mapping[str, WrittenInstance]) -> None:
        """Note an argument that a name of the resource stands in the way of."""
        if given.kind in ("value", "resource") and given.source is not None and given.text in meanings:
            what = meanings[given.text].meanings[given.text]
            said = f"the {what} `{given.text}` of the resource hides what is meant here: rename one of them"
            self._note(given.source, said)


def _made(instance: str, layers: list[Layer], found: list[Finding]) -> ResourceDocument | None:
    """The resource; None after all that is wrong with it has been noted."""
    content = content_of(instance, layers, found)
    if found:
        return None
    try:
        return ResourceDocument.model_validate(content)
    except ValidationError as error:
        found += _told_at_arguments(findings_of(error, document_of(instance, layers), (), ResourceDocument), layers)
        return None


def _told_at_arguments(findings: list[Finding], layers: list[Layer]) -> list[Finding]:
    """The same, with one at an argument for what is wrong wherever the type uses that."""
    places = {given.place for layer in layers[1:] for given in layer.arguments.values() if given.place is not None}
    told: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        told.setdefault((finding.place.instance, finding.message), []).append(finding)
    return [each for (where, _), alike in told.items() for each in _told_at_argument(where, alike, places)]


def _told_at_argument(where: str, alike: list[Finding], places: Collection[Place]) -> list[Finding]:
    given = next((each for each in places if where and with_given_at(where, each) == where), None)
    if given is None or len(alike) == 1:
        return alike
    first, count = min(each.place._replace(instance="") for each in alike), len(alike) - 1
    known = {"what": alike[0].message, "place": str(first)}
    if count == 1:
        return [Finding(given, message("wrong.at-argument", **known))]
    said = message("wrong.at-argument.several", count=count, **known)
    return [Finding(given, said)]
