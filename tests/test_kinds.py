# SPDX-License-Identifier: LGPL-2.1-or-later
"""Code never asks for the kind of a machine or a cell: `core/kinematics/arrangement.py` states its
consequences."""

import ast
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
# files that hold the values: the records, the parameter, the texts of the window, the purpose of a
# program
VALUE_FILES = {
    "core/kinematics/arrangement.py",
    "core/parameters/cell.py",
    "core/program.py",
    "gui/widgets/choices.py",
}
SETUPS = {"part-on-robot", "tool-on-robot", "rotary-table", "tool-on-robot+positioner"}


def find_kind_checks(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and node.value in SETUPS:
            yield f"line {node.lineno}: {node.value!r}"
        if isinstance(node, ast.Compare) and isinstance(
            node.ops[0], (ast.Eq, ast.NotEq, ast.In, ast.NotIn)
        ):
            checks = [
                side for side in (node.left, *node.comparators) if isinstance(side, ast.Attribute)
            ]
            yield from (
                f"line {node.lineno}: {side.attr}" for side in checks if side.attr == "setup"
            )


def test_no_file_asks_which_kind_of_cell_it_is():
    checks_by_file = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        if name in VALUE_FILES:
            continue
        checks = list(find_kind_checks(ast.parse(path.read_text(encoding="utf-8"))))
        if name.startswith(
            "posts/"
        ):  # posts reject set-ups by name, and ask the program for the consequences
            checks = [check for check in checks if check.endswith(": setup")]
        if checks:
            checks_by_file[name] = checks
    assert checks_by_file == {}


def test_the_question_is_recognised():
    for text in (
        "cell.setup == wanted",
        'setup in ("rotary-table",)',
        'if settings.setup != "x": pass',
    ):
        assert list(find_kind_checks(ast.parse(text))), text
    assert not list(find_kind_checks(ast.parse("cell.arrangement.free and f(setup=cell.setup)")))
