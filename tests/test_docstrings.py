# SPDX-License-Identifier: LGPL-2.1-or-later
"""Public functions document their parameters, in numpydoc sections that agree with their signatures."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
# packages whose functions of several parameters, or with arrays as results, all have sections
DOCUMENTED = ("api.py", "core", "posts")
SEVERAL = 3
SECTIONS = re.compile(r"^(Parameters|Returns|Yields)\n-+$", re.MULTILINE)
ENTRY = re.compile(r"^([*\w, ]+?)(?: : .*)?$")


def functions(path):
    """Class and node of the public functions and methods of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    places = [(None, tree)]
    while places:
        owner, place = places.pop()
        for node in place.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.append((node.name, node))
            elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                yield owner, node


def files(*names):
    """Files of packages."""
    paths = [PACKAGE / name for name in names]
    found = [file for path in paths for file in ([path] if path.suffix else path.rglob("*.py"))]
    return sorted(found)


def place_of(file):
    return file.relative_to(PACKAGE).as_posix()


def is_stub(node):
    """Whether a function only declares itself, as in a protocol of attributes."""
    return ast.unparse(node.body[-1]) == "..." and len(node.body) == 1


def parameters(node):
    """Names of the parameters in order, and all with `*args` and `**kwargs`."""
    arguments = node.args.posonlyargs + node.args.args + node.args.kwonlyargs
    names = [argument.arg for argument in arguments if argument.arg not in ("self", "cls")]
    extra = [argument.arg for argument in (node.args.vararg, node.args.kwarg) if argument]
    return names, {*names, *extra}


def documented_names(docstring):
    """Names in the section of parameters; None without one."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?:\n\n\S|\Z)", docstring, re.DOTALL | re.MULTILINE)
    if section is None:
        return None
    lines = [line for line in section[1].splitlines() if line and not line.startswith(" ")]
    entries = [ENTRY.match(line) for line in lines]
    assert all(entries), f"not entries of parameters: {lines}"
    return [name.strip(" *") for entry in entries for name in entry[1].split(",")]


@pytest.mark.parametrize("folder", ["api.py", "core", "macro", "posts", "read_back", "verify.py"])
def test_documented_parameters_are_those_of_the_signature(folder):
    wrong = []
    for path in files(folder):
        for _, node in functions(path):
            names = documented_names(ast.get_docstring(node) or "")
            in_order, everything = parameters(node)
            if names is None:
                continue
            stated = [name for name in names if name in in_order]
            if not set(names) <= everything or stated != in_order:
                wrong.append(f"{place_of(path)}:{node.lineno} {node.name}: {names}")
    assert not wrong, "\n".join(wrong)


def has_sections(node):
    return SECTIONS.search(ast.get_docstring(node) or "") is not None


def test_functions_of_several_parameters_document_them():
    interfaces = {
        node.name
        for path in files("core", "posts")
        for owner, node in functions(path)
        if owner is not None and has_sections(node)
    }
    modules_alike = {"refuse_setup"}  # `posts.catalogue.Post` documents it for all posts
    missing = []
    for path in files(*DOCUMENTED):
        for owner, node in functions(path):
            if has_sections(node) or is_stub(node) or node.name in modules_alike:
                continue
            if owner is not None and node.name in interfaces:
                continue
            returned = "" if node.returns is None else ast.unparse(node.returns)
            if len(parameters(node)[0]) >= SEVERAL or "Array" in returned:
                missing.append(f"{place_of(path)}:{node.lineno} {node.name} -> {returned}")
    assert not missing, "\n".join(missing)


def test_sections_are_read():
    docstring = (
        "Do it.\n\nParameters\n----------\na, b : int\n    Two.\n*more\n    Further.\n\n"
        "Returns\n-------\nint\n    One."
    )
    assert documented_names(docstring) == ["a", "b", "more"]
    assert documented_names("Do it.") is None
