"""What a station shows at rest: all that is news, and besides only that it is alive."""

from __future__ import annotations

from sequence_planner.controller.views.builder import Shown
from support.example_view import example_view


def test_only_times_and_counts_are_no_news() -> None:
    shown, view = Shown(), example_view()
    assert shown.is_news(view)
    topics = {
        name: each.model_copy(update={"last": 7.0, "messages": each.messages + 1}) for name, each in view.topics.items()
    }
    assert topics
    later = view.model_copy(update={"time": view.time + 0.5, "topics": topics})
    assert not shown.is_news(later)


def test_all_else_is_news_and_is_compared_with_what_was_shown() -> None:
    view = example_view()
    name, topic = next(iter(view.topics.items()))
    changes: list[dict[str, object]] = [
        {"revision": view.revision + 1},
        {"silent": ["robot"]},
        {"variables": {}},
        {"topics": {**view.topics, name: topic.model_copy(update={"fresh": not topic.fresh})}},
    ]
    for change in changes:
        shown = Shown()
        shown.is_news(view)
        other = view.model_copy(update=change)
        assert shown.is_news(other), change
        assert not shown.is_news(other)
        assert shown.is_news(view)


def test_it_is_compared_with_what_was_shown_last_whoever_has_shown_it() -> None:
    shown, view = Shown(), example_view()
    shown.is_news(view)
    shown.note(view.model_copy(update={"revision": view.revision + 1}))
    assert shown.is_news(view)
