# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window shows those parameters of `program.nc` that a post reads: the test compares its table
with the sources of the posts."""

import ast
import dataclasses
from pathlib import Path

import pytest

from freecad_am.core.parameters.program import NcParameters
from freecad_am.posts import catalogue

POSTS = Path(catalogue.__file__).parent
NAMES = {field.name for field in dataclasses.fields(NcParameters)}
PROPERTIES = {"path_feed": "feed"}  # a post reads this property in place of the parameter


def read_in(folder, functions=None):
    """Return the parameters read as `….nc.NAME` in a file, the files of a folder, or some functions
    and classes of a file."""
    names = set()
    for file in [folder] if folder.is_file() else folder.glob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        roots = (
            [tree]
            if functions is None
            else [node for node in ast.walk(tree) if getattr(node, "name", None) in functions]
        )
        for node in (node for root in roots for node in ast.walk(root)):
            if (
                isinstance(node, ast.Attribute)
                and isinstance(node.value, ast.Attribute)
                and node.value.attr == "nc"
            ):
                names.add(PROPERTIES.get(node.attr, node.attr))
    return names & NAMES


def called(folder):
    """Return the names of the functions and classes of posts/nc_numbers.py that the files of a
    folder call."""
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
    own_parameters = read_in(POSTS / post)
    shared = read_in(POSTS / "nc_numbers.py", called(POSTS / post)) if own_parameters else set()
    assert own_parameters | shared == set(catalogue.NC_PARAMETERS.get(post, ()))


def test_of_an_unknown_post_all_is_shown():
    assert all(catalogue.reads_nc("of a plugin", name) for name in NAMES)
    assert not any(catalogue.reads_nc("none", name) for name in NAMES)
