# SPDX-License-Identifier: LGPL-2.1-or-later
"""No identifier of the package has a word that the field does not use; docs/decisions/0020 has what is said instead."""

import ast
import functools
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
FORBIDDEN = {
    "beside": "adjacent, neighbours, external, outside",
    "counted": "unwrapped, valid",
    "endless": "continuous",
    "laid": "deposited, unroll",
    "lift": "retract", "lifted": "raised", "lifts": "retracts",
    "pace": "achievable_feed, rate", "paces": "speed_ratios",
    "rod": "cylinder", "rods": "cylinders",
    "rolled": "wrapped",
    "room": "margin, clearance, space", "rooms": "margins",
    "settle": "resolve", "settled": "resolved, CONVERGED", "settles": "resolves", "settling": "resolving",
    "spin": "rotation, redundancy", "spins": "rotations", "spun": "rotated",
    "surroundings": "obstacles",
    "told": "text, messages, reported, given", "unwind": "rewind", "valley": "ties",
    "withdrawn": "retracted",
}
ADJECTIVES = {"ALIKE", "FAR", "FEW", "HARDLY", "LITTLE", "LONG", "MOST", "NEAR", "SAME", "SHORT", "SMALL"}  # say of what
# name: the files that may have it, and why
KEPT = {
    "surroundings": (
        {
            "core/geometry/curves/bead_curves", "core/geometry/curves/profile", "core/geometry/on_hub",
            "core/geometry/walls/clad_faces", "core/geometry/walls/patch_wall", "core/geometry/walls/surface_wall",
            "core/toolpath",
        }, "documents store these fields by name",
    ),
    "laid": ({"core/geometry/fitted", "core/inspection/inspect"}, "documents store these fields by name"),
    "counted": ({"core/inspection/inspect"}, "documents store this field by name"),
    "lift": ({"core/parameters/process"}, "a key of job files, `process.between_layers.lift`"),
    "told_to": ({"objects/work/progress"}, "a function of freecad_am.api"),
    "valley": ({"core/process/shape/laying"}, "what lies between two beads"),
}


def words(name):
    """Those of an identifier, in small letters."""
    return {word.lower() for word in re.split(r"_|(?<=[a-z0-9])(?=[A-Z])", name) if word}


def names(tree):
    """Every name that a file gives to something of its own, and whether it is a constant of the module."""
    top = {target.id for node in tree.body if isinstance(node, (ast.Assign, ast.AnnAssign))
           for target in ast.walk(node) if isinstance(target, ast.Name) and isinstance(target.ctx, ast.Store)}
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield node.name, False
        elif isinstance(node, ast.arg):
            yield node.arg, False
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id, node.id in top
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr, False
        elif isinstance(node, ast.alias) and node.asname:
            yield node.asname, False
        elif isinstance(node, (ast.ExceptHandler, ast.MatchAs)) and node.name:
            yield node.name, False


@functools.cache
def files():
    """The names of each file of the package, by its path."""
    return {
        str(path.relative_to(PACKAGE).with_suffix("")): set(names(ast.parse(path.read_text(encoding="utf-8"))))
        for path in sorted(PACKAGE.rglob("*.py"))
    }


def test_identifiers_have_the_words_of_the_field():
    wrong = set()
    for file, found in files().items():
        for part in file.split("/"):
            wrong |= {f"{file}: {word}, say {FORBIDDEN[word]}" for word in words(part) & FORBIDDEN.keys()}
        for name, constant in found:
            bad = words(name) & FORBIDDEN.keys()
            if bad and file not in KEPT.get(name, ({},))[0]:
                wrong |= {f"{file}: {name}, say {FORBIDDEN[word]}" for word in bad}
            if constant and name.strip("_") in ADJECTIVES:
                wrong.add(f"{file}: {name} names no thing")
    assert sorted(wrong) == []


def test_no_exception_outlives_its_reason():
    there = {file: {name for name, _ in found} for file, found in files().items()}
    assert [(name, file) for name, (kept, _) in KEPT.items() for file in kept if name not in there[file]] == []


def test_words_are_found_in_names_of_every_form():
    tree = ast.parse("import a as rod_of\nSAME = 1\nclass SpinMap: laid: int\ndef f(pace): told = [room for room in pace]")
    found = {word for name, _ in names(tree) for word in words(name) & FORBIDDEN.keys()}
    assert found == {"rod", "spin", "laid", "pace", "told", "room"} and ("SAME", True) in set(names(tree))
