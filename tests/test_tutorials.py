# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every tutorial is done by a test of the window: its headings are the steps, its pictures those that the test takes."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
IMAGES = ROOT / "docs" / "tutorials" / "images"
LESSONS = [path for path in PAGES if path.name != "README.md"]
ROOM = 3_000_000  # bytes of all pictures


def lessons():
    """(page, steps, pictures) of each test: the literals of its calls, in the order of the file."""
    for path in sorted((ROOT / "tests" / "gui" / "tutorials").glob("test_*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        page = next(
            node.value.value
            for node in tree.body
            if isinstance(node, ast.Assign) and node.targets[0].id == "PAGE"
        )
        calls = sorted(
            (
                node
                for node in ast.walk(tree)
                if isinstance(node, ast.Call)
                and isinstance(node.func, ast.Attribute)
                and node.func.attr in ("step", "picture")
            ),
            key=lambda node: node.lineno,
        )
        yield page, [(call.func.attr, call.args[0].value) for call in calls]


DONE = dict(lessons())


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_a_tutorial_is_what_its_test_does(page):
    text = page.read_text(encoding="utf-8")
    found = re.findall(r"^## (\d+\. .+)$|!\[[^\]]+\]\(images/([\w-]+)\.png\)", text, re.MULTILINE)
    told = [
        ("step", heading.strip()) if heading else ("picture", picture) for heading, picture in found
    ]
    assert told == DONE[page.stem]
    assert 5 <= sum(kind == "picture" for kind, _ in told) <= 9


def test_every_test_has_its_tutorial():
    assert set(DONE) == {page.stem for page in LESSONS} and len(DONE) == 7


def test_pictures_are_those_of_the_tutorials_and_small():
    taken = {name for calls in DONE.values() for kind, name in calls if kind == "picture"}
    assert {path.stem for path in IMAGES.iterdir()} == taken
    assert sum(path.stat().st_size for path in IMAGES.iterdir()) < ROOM
