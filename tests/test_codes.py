# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/codes.md lists the codes of all messages, and none that there is not."""

import ast
import re

import pytest

# what raises or tells messages, and which argument is their code
TELLS = {"InputError": 0, "InfeasibleError": 0, "Issue": 1, "issue": 0}
CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")
# of the console, not of a message that is made as one
OWN = {"INTERNAL", "MORE"}


@pytest.fixture(scope="module")
def trees(root):
    return {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted((root / "freecad_am").rglob("*.py"))}


@pytest.fixture(scope="module")
def listed(root):
    page = (root / "docs" / "codes.md").read_text(encoding="utf-8")
    return [code for code in re.findall(r"`([A-Z0-9_]+)`", page) if code not in ("FREECAD_AM_PYTHON", "CODE")]


def constants(trees):
    """Words that names stand for, of all modules; a name may stand for several."""
    found = {}
    for tree in trees.values():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Assign):
                continue
            for target in node.targets:
                pairs = [(target, node.value)]
                if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                    pairs = zip(target.elts, node.value.elts)
                for name, value in pairs:
                    if isinstance(name, ast.Name) and isinstance(value, ast.Constant) and isinstance(value.value, str):
                        found.setdefault(name.id, set()).add(value.value)
    return found


def told(trees):
    """The codes that stand where messages are made, themselves or by a name in capitals."""
    names, found = constants(trees), set()
    for tree in trees.values():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call):
                continue
            called = getattr(node.func, "id", getattr(node.func, "attr", ""))
            place = TELLS.get(called)
            if place is None or len(node.args) <= place:
                continue
            code = node.args[place]
            if isinstance(code, ast.Constant) and isinstance(code.value, str):
                found.add(code.value)
            name = getattr(code, "id", getattr(code, "attr", ""))
            if name.isupper():
                found |= names.get(name, set())
    return {code for code in found if CODE.fullmatch(code) and len(code) > 2}


def test_each_code_that_is_told_is_listed(trees, listed):
    assert len(told(trees)) > 200
    assert sorted(told(trees) - set(listed)) == []


def test_each_code_that_is_listed_is_told_and_listed_once(trees, listed):
    words = {node.value for tree in trees.values() for node in ast.walk(tree)
             if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    spelled = " ".join(word for word in words if "[" in word)  # lines that the console writes itself
    assert [code for code in listed if code not in words and f"[{code}]" not in spelled] == []
    assert sorted(code for code in set(listed) if listed.count(code) > 1) == []
