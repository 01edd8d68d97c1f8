# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/codes.md lists the codes of all messages and no others."""

import ast
import re

import pytest

# calls that raise or report messages, and the position of their code argument
CODE_POSITIONS = {"InputError": 0, "InfeasibleError": 0, "Issue": 1, "issue": 0}
CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*")


class CodeCollector(ast.NodeVisitor):
    """Collect all words of the modules, the values of names, and the codes of messages, given as
    text or by name."""

    def __init__(self):
        self.words, self.names, self.codes, self.named = set(), {}, set(), set()

    def visit_Constant(self, node):
        if isinstance(node.value, str):
            self.words.add(node.value)

    def visit_Assign(self, node):
        for target in node.targets:
            pairs = [(target, node.value)]
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                pairs = zip(target.elts, node.value.elts)
            for name, value in pairs:
                if (
                    isinstance(name, ast.Name)
                    and isinstance(value, ast.Constant)
                    and isinstance(value.value, str)
                ):
                    self.names.setdefault(name.id, set()).add(value.value)
        self.generic_visit(node)

    def visit_Call(self, node):
        position = CODE_POSITIONS.get(getattr(node.func, "id", getattr(node.func, "attr", "")))
        if position is not None and len(node.args) > position:
            code = node.args[position]
            if isinstance(code, ast.Constant) and isinstance(code.value, str):
                self.codes.add(code.value)
            self.named.add(getattr(code, "id", getattr(code, "attr", "")))
        self.generic_visit(node)

    def told(self):
        named = set().union(*(self.names.get(name, set()) for name in self.named if name.isupper()))
        return {code for code in self.codes | named if CODE.fullmatch(code) and len(code) > 2}


@pytest.fixture(scope="module")
def found(root):
    collector = CodeCollector()
    for path in (root / "freecad_am").rglob("*.py"):
        collector.visit(ast.parse(path.read_text(encoding="utf-8")))
    return collector


@pytest.fixture(scope="module")
def listed(root):
    page = (root / "docs" / "codes.md").read_text(encoding="utf-8")
    return [code for code in re.findall(r"`([A-Z0-9_]+)`", page) if code != "FREECAD_AM_PYTHON"]


def test_each_code_that_is_told_is_listed(found, listed):
    assert len(found.told()) > 200
    assert sorted(found.told() - set(listed)) == []


def test_each_code_that_is_listed_is_told_and_listed_once(found, listed):
    spelled = " ".join(
        word for word in found.words if "[" in word
    )  # lines that the console itself writes
    assert [code for code in listed if code not in found.words and f"[{code}]" not in spelled] == []
    assert sorted(code for code in set(listed) if listed.count(code) > 1) == []
