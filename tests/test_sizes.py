# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files are read on a screen or three, functions on one: those that are longer are named here, and grow no longer."""

import ast
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
FILE, FUNCTION = 300, 40  # lines
LONG_FILES = {
    "core/toolpath.py": 370,
}
LONG_FUNCTIONS = {
    "api.py make_all": 45,
    "batch/supervised.py supervised": 43,
    "brep/revolution/axis.py from_normals": 41,
    "core/collision/deposit.py of_beads": 54,
    "core/geometry/mesh/refined.py refined": 46,
    "core/geometry/regions/chained.py chained": 49,
    "core/geometry/walls/contact.py _rounded": 47,
    "core/kinematics/inverse/parallel_axes.py _solve_piece": 52,
    "core/kinematics/machines/machine.py _parse": 48,
    "core/kinematics/inverse/opw_recognition.py _arm": 50,
    "core/planning/methods/layer_by_layer.py _searched": 49,
    "core/process/model/bead_table.py measured": 44,
    "core/process/deposit/support.py _alone": 49,
    "core/simulation/rapid_look.py looked_at": 45,
    "core/strategies/cladding.py plan": 46,
    "core/strategies/solids/lean.py _spread": 46,
    "core/strategies/solids/plan.py plan": 57,
    "gui/redundancy_map/controls.py __init__": 50,
    "gui/tools/export_path.py __init__": 46,
    "objects/planned/proposed_family.py proposed": 66,
    "posts/staubli/moves.py moves_of": 47,
    "read_back/times.py time_issues": 44,
}


def sources():
    for path in sorted(PACKAGE.rglob("*.py")):
        yield path.relative_to(PACKAGE).as_posix(), path.read_text(encoding="utf-8")


def test_files_are_short():
    lengths = {name: len(text.splitlines()) for name, text in sources()}
    long = {name: lines for name, lines in lengths.items() if lines > FILE}
    assert {name: lines for name, lines in long.items() if lines > LONG_FILES.get(name, 0)} == {}
    assert LONG_FILES.keys() - long.keys() == set(), "no longer long: take these off the list"


def test_functions_are_short():
    long = {}
    for name, text in sources():
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef) and (lines := node.end_lineno - node.lineno + 1) > FUNCTION:
                long[f"{name} {node.name}"] = lines
    assert {name: lines for name, lines in long.items() if lines > LONG_FUNCTIONS.get(name, 0)} == {}
    assert LONG_FUNCTIONS.keys() - long.keys() == set(), "no longer long: take these off the list"
