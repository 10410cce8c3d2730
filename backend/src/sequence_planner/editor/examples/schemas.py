"""The things that are told of the example stations."""

from __future__ import annotations

from sequence_planner.controller.views.part import View


class ExampleView(View):
    """An example station by its `name`: its title by language, what it is in a sentence, and how large."""

    name: str
    title: dict[str, str]
    description: str
    resources: int
    abilities: int
    operations: int


class ExamplesView(View):
    """The example stations that can be looked at and begun with; none where the program was installed without them."""

    examples: list[ExampleView]
