# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window shows of `program.nc` what a post reads: the table is held against the sources of the posts."""

import ast
import dataclasses
from pathlib import Path

import pytest

from freecad_am.core.parameters.program import NcParameters
from freecad_am.posts import catalogue

POSTS = Path(catalogue.__file__).parent
NAMES = {field.name for field in dataclasses.fields(NcParameters)}
PROPERTIES = {"path_feed": "feed"}  # what a post reads in place of a parameter


def read_in(folder, functions=None):
    """Parameters read as `….nc.NAME` in a file or the files of a folder, or in some of its functions and classes."""
    found = set()
    for file in [folder] if folder.is_file() else folder.glob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        parts = (
            [tree]
            if functions is None
            else [node for node in ast.walk(tree) if getattr(node, "name", None) in functions]
        )
        for node in (node for part in parts for node in ast.walk(part)):
            if (
                isinstance(node, ast.Attribute)
                and isinstance(node.value, ast.Attribute)
                and node.value.attr == "nc"
            ):
                found.add(PROPERTIES.get(node.attr, node.attr))
    return found & NAMES


def called(folder):
    """Names of functions and classes of posts/nc_numbers.py that the files of a folder call."""
    trees = (ast.parse(file.read_text(encoding="utf-8")) for file in folder.glob("*.py"))
    return {
        node.attr
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "nc_numbers"
    }


@pytest.mark.parametrize("post", catalogue.NAMES)
def test_the_table_names_what_a_post_reads(post):
    own = read_in(POSTS / post)
    shared = read_in(POSTS / "nc_numbers.py", called(POSTS / post)) if own else set()
    assert own | shared == set(catalogue.NC_PARAMETERS.get(post, ()))


def test_of_an_unknown_post_all_is_shown():
    assert all(catalogue.reads_nc("of a plugin", name) for name in NAMES)
    assert not any(catalogue.reads_nc("none", name) for name in NAMES)
