"""The differences of texts as `diff -u` shows them."""

from __future__ import annotations

from sequence_planner.editor.comparing.diff import text_differences


def test_only_files_that_differ_are_told_with_what_is_new_and_gone() -> None:
    found = text_differences({"a.yaml": "x\ny\n", "b.yaml": "same\n"}, {"b.yaml": "same\n", "c.yaml": "z\n"})
    assert found == {
        "a.yaml": "--- a/a.yaml\n+++ b/a.yaml\n@@ -1,2 +0,0 @@\n-x\n-y\n",
        "c.yaml": "--- a/c.yaml\n+++ b/c.yaml\n@@ -0,0 +1 @@\n+z\n",
    }


def test_a_line_without_an_end_is_not_run_together_with_the_next() -> None:
    assert text_differences({"a.yaml": "x: 1"}, {"a.yaml": "x: 2\n"})["a.yaml"].splitlines()[2:] == [
        "@@ -1 +1 @@",
        "-x: 1",
        "\\ No newline at end of file",
        "+x: 2",
    ]


def test_nothing_but_a_new_line_ends_a_line() -> None:
    found = text_differences({"a.yaml": "x: 1\n"}, {"a.yaml": "x: 1\u2028\x0cy\n"})["a.yaml"]
    assert found.split("\n")[2:] == ["@@ -1 +1 @@", "-x: 1", "+x: 1\u2028\x0cy", ""]
