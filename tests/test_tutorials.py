# SPDX-License-Identifier: LGPL-2.1-or-later
"""A test of the window performs each tutorial: the headings are its steps, the pictures are those
it takes."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
IMAGES = ROOT / "docs" / "tutorials" / "images"
LESSONS = [path for path in PAGES if path.name != "README.md"]
MAX_PICTURE_BYTES = 3_000_000  # bytes of all pictures together


def lessons():
    """Return (page, steps, pictures) of each test, from the literals of its calls in the order of
    the file."""
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


PERFORMED_LESSONS = dict(lessons())


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_a_tutorial_is_what_its_test_does(page):
    text = page.read_text(encoding="utf-8")
    page_steps = re.findall(
        r"^## (\d+\. .+)$|!\[[^\]]+\]\(images/([\w-]+)\.png\)", text, re.MULTILINE
    )
    test_steps = [
        ("step", heading.strip()) if heading else ("picture", picture)
        for heading, picture in page_steps
    ]
    assert test_steps == PERFORMED_LESSONS[page.stem]
    assert 5 <= sum(kind == "picture" for kind, _ in test_steps) <= 9


def test_every_test_has_its_tutorial():
    assert set(PERFORMED_LESSONS) == {page.stem for page in LESSONS} and len(PERFORMED_LESSONS) == 7


def test_pictures_are_those_of_the_tutorials_and_small():
    pictures = {
        name for calls in PERFORMED_LESSONS.values() for kind, name in calls if kind == "picture"
    }
    assert {path.stem for path in IMAGES.iterdir()} == pictures
    assert sum(path.stat().st_size for path in IMAGES.iterdir()) < MAX_PICTURE_BYTES
