# SPDX-License-Identifier: LGPL-2.1-or-later
"""Public functions document their parameters in numpydoc sections that match their signatures."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
# packages in which every function with several parameters or array results has numpydoc sections
DOCUMENTED = ("api.py", "core", "posts")
SEVERAL = 3
SECTIONS = re.compile(r"^(Parameters|Returns|Yields)\n-+$", re.MULTILINE)
ENTRY = re.compile(r"^([*\w, ]+?)(?: : .*)?$")


def functions(path):
    """Return the class and the node of each public function and method of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    pending = [(None, tree)]
    while pending:
        owner, scope = pending.pop()
        for node in scope.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                pending.append((node.name, node))
            elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                yield owner, node


def files(*names):
    """Return the Python files of the packages."""
    paths = [PACKAGE / name for name in names]
    paths_found = [
        file for path in paths for file in ([path] if path.suffix else path.rglob("*.py"))
    ]
    return sorted(paths_found)


def place_of(file):
    return file.relative_to(PACKAGE).as_posix()


def is_stub(node):
    """Return whether a function is only a declaration, as in a protocol."""
    return ast.unparse(node.body[-1]) == "..." and len(node.body) == 1


def parameters(node):
    """Return the parameter names in order, and all names including `*args` and `**kwargs`."""
    arguments = node.args.posonlyargs + node.args.args + node.args.kwonlyargs
    names = [argument.arg for argument in arguments if argument.arg not in ("self", "cls")]
    extra = [argument.arg for argument in (node.args.vararg, node.args.kwarg) if argument]
    return names, {*names, *extra}


def documented_names(docstring):
    """Return the names in the Parameters section, None without a section."""
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
    modules_alike = {"refuse_setup"}  # `posts.catalogue.Post` documents this function for all posts
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
