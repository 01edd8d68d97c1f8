# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which kind a machine or a cell is, is asked nowhere: `core/kinematics/arrangement.py` says what follows from it."""

import ast
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
# where the values are: the records, the parameter, the words of the window, what a program is for
TOLD_IN = {
    "core/kinematics/arrangement.py",
    "core/parameters/cell.py",
    "core/program.py",
    "gui/widgets/choices.py",
}
SETUPS = {"part-on-robot", "tool-on-robot", "rotary-table", "tool-on-robot+positioner"}


def _of_kind(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and node.value in SETUPS:
            yield f"line {node.lineno}: {node.value!r}"
        if isinstance(node, ast.Compare) and isinstance(
            node.ops[0], (ast.Eq, ast.NotEq, ast.In, ast.NotIn)
        ):
            asked = [
                side for side in (node.left, *node.comparators) if isinstance(side, ast.Attribute)
            ]
            yield from (
                f"line {node.lineno}: {side.attr}" for side in asked if side.attr == "setup"
            )


def test_no_file_asks_which_kind_of_cell_it_is():
    asked = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        if name in TOLD_IN:
            continue
        found = list(_of_kind(ast.parse(path.read_text(encoding="utf-8"))))
        if name.startswith(
            "posts/"
        ):  # which refuse set-ups by their names, and ask programs what follows
            found = [one for one in found if one.endswith(": setup")]
        if found:
            asked[name] = found
    assert asked == {}


def test_the_question_is_recognised():
    for text in (
        "cell.setup == wanted",
        'setup in ("rotary-table",)',
        'if settings.setup != "x": pass',
    ):
        assert list(_of_kind(ast.parse(text))), text
    assert not list(_of_kind(ast.parse("cell.arrangement.free and f(setup=cell.setup)")))
