# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modules ask a family of features for facts and do not compare its kind: `core/families` states
the consequences."""

import ast
import functools
import re
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.families.registry import AUTO, FAMILIES
from freecad_am.core.families.registry import KINDS as KINDS_OF
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.filled import FILLS

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
KINDS = {family.kind for family in FAMILIES}
NAMES = {kind.upper() for kind in KINDS}  # constants with the name of a kind
FEATURE_CLASSES = {family.parameters.__name__ for family in FAMILIES} | {
    f"{type(family).__name__}Feature" for family in FAMILIES
}
WALL_CLASSES = {"RevolvedWall", "PatchWall", "SurfaceWall", "SolidsOnHub", "CladFaces"}
# comparisons with a kind, and tests of the class of parameters, features and walls; only goes down
MAX_SWITCHES = 0
MAX_FILES_OF_A_FAMILY = 12  # files that contain its kind as a string
LAYERS = {"planes", "geodesic", "offset", "along", "PLANES", "GEODESIC", "OFFSET"}
MAX_LAYER_SWITCHES = 9  # comparisons with a kind of layers
MAX_FILL_SWITCHES = 12  # comparisons with a fill, mostly where it is planned; three are other words
OTHER_WORDS = {  # files in which such a word is not a kind
    "brep/files/read.py",
    "brep/files/three_mf.py",
    "core/geometry/curves/gcode.py",
    "core/geometry/curves/gcode_roles.py",
}


@functools.cache
def modules():
    """Return (name below the package, nodes of the syntax tree) of every module."""
    names = {path.relative_to(PACKAGE).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}
    return [
        (name, list(ast.walk(ast.parse(path.read_text(encoding="utf-8")))))
        for name, path in names.items()
        if name not in OTHER_WORDS
    ]


def kinds_in(tree):
    """Return the kinds that are strings of a syntax tree."""
    return {
        node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)
    } & KINDS  # an unhashable constant does not exist


def identifiers(tree):
    """Return the names and attributes of a syntax tree."""
    return {
        node.id if isinstance(node, ast.Name) else node.attr
        for node in ast.walk(tree)
        if isinstance(node, (ast.Name, ast.Attribute))
    }


def is_none(comparison):
    """Return whether a comparison is with None."""
    return isinstance(comparison.ops[0], (ast.Is, ast.IsNot))


def is_switch(node):
    """Return whether a node compares the kind of a feature, looks it up in a table, or tests a
    class of a family."""
    if isinstance(node, ast.Compare):
        sides = (node.left, *node.comparators)
        attributes = {side.attr for side in sides if isinstance(side, ast.Attribute)}
        has_kind = any(kinds_in(side) or identifiers(side) & NAMES for side in sides)
        return has_kind or ("family" in attributes and not is_none(node))
    if isinstance(node, ast.Dict):
        return len(kinds_in(ast.Tuple([key for key in node.keys if key is not None]))) > 1
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "isinstance":
        return bool(identifiers(node.args[1]) & (FEATURE_CLASSES | WALL_CLASSES))
    return False


def compares(node, words):
    """Return whether a node compares with one of some words or constants."""
    if not isinstance(node, ast.Compare):
        return False
    compared = [node.left, *node.comparators]
    texts = {
        node_.value
        for side in compared
        for node_ in ast.walk(side)
        if isinstance(node_, ast.Constant) and isinstance(node_.value, str)
    }
    constants = {name for name in set().union(*map(identifiers, compared)) if name.isupper()}
    return bool(words & (texts | constants))


@pytest.mark.parametrize(
    ("words", "most"), [(LAYERS, MAX_LAYER_SWITCHES), (set(FILLS), MAX_FILL_SWITCHES)]
)
def test_comparisons_with_layers_and_fills_are_few(words, most):
    comparisons = [
        f"{name}:{node.lineno}"
        for name, nodes in modules()
        for node in nodes
        if compares(node, words)
    ]
    assert 0 < len(comparisons) <= most, comparisons


def test_fills_that_replace_others_are_fills():
    assert all(not fill.all_round or fill.all_round in FILLS for fill in FILLS.values())


def test_switches_on_the_kind_of_a_feature_are_few():
    switches = [
        f"{name}:{node.lineno}" for name, nodes in modules() for node in nodes if is_switch(node)
    ]
    assert len(switches) <= MAX_SWITCHES, switches


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_family_is_named_in_few_modules(kind):
    named = [
        name
        for name, nodes in modules()
        if any(isinstance(node, ast.Constant) and node.value == kind for node in nodes)
    ]
    assert 0 < len(named) <= MAX_FILES_OF_A_FAMILY, named


def test_switches_are_recognised():
    for text in (
        'toolpath.family == "revolution"',
        'kind not in ("solid", "curves")',
        "job.kind == CLADDING",
        "isinstance(wall, PatchWall)",
        "isinstance(strategy, (SolidParameters, int))",
        'PLANNERS = {"solid": plan_solid, "curves": plan_curves}',
    ):
        assert any(is_switch(node) for node in ast.walk(ast.parse(text))), text
    for text in ("toolpath.traits.has_axis", 'kind == "auto"', 'Toolpath(layers, "curves")'):
        assert not any(is_switch(node) for node in ast.walk(ast.parse(text))), text


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.kind)
def test_the_files_of_a_family_are_complete(family):
    from freecad_am.macro.features import proxy_of
    from freecad_am.objects.families.registry import planner_of, stage_family

    planner, proxy = planner_of(family), proxy_of(family.kind)
    assert proxy.__name__ == planner.proxy[1] == f"{type(family).__name__}Feature"
    assert stage_family(proxy) is family
    window = (PACKAGE / "gui" / "families" / f"{family.kind}.py").read_text(encoding="utf-8")
    assert f"class {type(family).__name__}Window(FeatureWindow):" in window
    for method in ("tools", "panel", "entries", "assign_roles"):
        assert f"def {method}(" in window, method
    page = re.search(r'page = "([\w-]+)"', window)[1]
    assert (PACKAGE.parent / "docs" / "tools" / f"{page}.md").is_file()


def test_families_are_asked_in_one_order():
    """Solids come last, because they recognise every part."""
    from freecad_am.objects.families.registry import ranked_planners

    ranks = [planner.recognition_rank for planner in ranked_planners()]
    assert len(set(ranks)) == len(ranks) > 0 and ranks == sorted(ranks)
    assert ranked_planners()[-1].proxy[1] == "SolidFeature"


def test_families_without_a_planned_surface_refuse_to_be_compared():
    from freecad_am.core.inspection.planned import revolution_surface
    from freecad_am.objects.families.registry import planner_of
    from tests.core.inspection_parts import hemisphere

    def surface(kind, value):
        return planner_of(KINDS_OF[kind]).planned_surface(value, "Feature")

    for kind in ("curves", "cladding"):
        with pytest.raises(InputError, match="no planned surface") as caught:
            surface(kind, None)
        assert (caught.value.code, caught.value.where) == ("NOT_FOR_FAMILY", "Feature")
    wall = hemisphere()
    above = np.array([[0.0, 0.0, 60.0]])
    distance, expected = (
        surface_.exact(above)[0]
        for surface_ in (surface("revolution", wall), revolution_surface(wall))
    )
    assert distance == pytest.approx(expected)


def test_modes_are_those_of_the_parameter():
    for family in FAMILIES:
        assert set(family.modes) <= set(AUTO.modes)
        assert family.mode_refusal or set(family.modes) == set(AUTO.modes)
