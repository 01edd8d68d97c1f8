# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of imports of docs/architecture.md, enforced: data flows one way, hosts stay where they belong."""

import ast
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"

# folder or module -> what of our own it may import besides itself
OURS = {
    "core/issues": set(),
    "core/program": set(),
    "core/motion": set(),
    "core/one_thread": set(),
    "core/parameters": {"core/issues"},
    "core/geometry": {"core/issues"},
    "core/filling": {"core/issues", "core/geometry"},
    "core/toolpath": {"core/issues", "core/geometry"},
    "core/slicing": {"core/issues", "core/parameters", "core/geometry", "core/toolpath"},
    "core/layers": {"core/issues", "core/parameters", "core/geometry", "core/collision", "core/slicing"},
    "core/process": {"core/issues", "core/parameters", "core/geometry", "core/toolpath"},
    "core/inspection": {"core/issues", "core/parameters", "core/geometry", "core/toolpath"},
    "core/collision": {"core/geometry"},
    "core/strategies": {
        "core/issues", "core/parameters", "core/geometry", "core/collision", "core/filling", "core/toolpath", "core/slicing",
        "core/layers", "core/process",
    },
    "core/kinematics": {"core/issues", "core/parameters", "core/geometry", "core/collision"},
    "core/planning": {
        "core/issues", "core/parameters", "core/geometry", "core/collision", "core/toolpath", "core/kinematics",
        "core/motion", "core/program",
    },
    "core/simulation": {
        "core/issues", "core/parameters", "core/geometry", "core/collision", "core/toolpath", "core/kinematics",
        "core/motion",
    },
    "core/preflight": {
        "core/issues", "core/parameters", "core/geometry", "core/toolpath", "core/process", "core/kinematics", "core/motion",
        "core/simulation", "core/strategies",
    },
    "posts": {"core/issues", "core/program"},
    "kdl": {"core/issues", "core/geometry", "core/kinematics"},
    "read_back": {"core/issues", "core/geometry", "core/kinematics", "core/motion", "core/program", "kdl"},
    "verify": {"core/issues", "core/geometry", "core/kinematics", "core/motion", "core/program", "posts", "read_back"},
    "brep": {"core/issues", "core/geometry", "core/one_thread", "core/collision"},
    "objects": {"core", "brep", "posts", "verify", "kdl"},
    "interop": {"core", "objects"},
    "api": {"core", "brep", "objects", "posts", "interop"},
    "plots": {"core"},
    "batch": {"core", "api", "objects", "posts", "kdl", "brep", "verify", "plots"},
    "gui": {"core", "api", "objects", "posts", "brep", "plots"},
}
# the foreign modules a part of the package may use besides the standard library
FOREIGN = {
    "core": {"numpy", "scipy"},
    "posts": {"numpy"},
    "read_back": {"numpy"},
    "verify": {"numpy"},
    "kdl": {"numpy", "PyKDL"},
    "brep": {"numpy", "scipy", "FreeCAD", "Part", "Mesh", "MeshPart"},
    "objects": {"numpy", "FreeCAD", "Part"},
    "interop": {"numpy", "FreeCAD", "Part", "Import", "Path", "Robot"},
    "api": {"numpy", "FreeCAD"},
    "plots": {"numpy", "matplotlib"},
    "batch": {"numpy", "yaml", "FreeCAD"},
    "gui": {"numpy", "FreeCAD", "FreeCADGui", "PySide", "pivy"},
}
# single files that may use more
ALONE = {"core/geometry/region": {"shapely"}}


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py") if path.stat().st_size)


def home(path):
    """The row of OURS a file belongs to, such as core/slicing or posts."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return "/".join(parts[:2]) if parts[0] == "core" else parts[0]


def imported(path):
    """(module, names) of every import statement of a file, ours as dotted paths below the package."""
    package = ["freecad_am", *path.relative_to(PACKAGE).parts[:-1]]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, ()
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            yield ".".join([*base, *(node.module or "").split(".")]).strip("."), tuple(alias.name for alias in node.names)


def ours(module, names):
    """The rows of OURS an import of ours touches."""
    parts = module.split(".")[1:]
    if not parts:
        return set(names)
    if parts[0] != "core":
        return {parts[0]}
    return {"/".join(parts[:2])} if len(parts) > 1 else {f"core/{name}" for name in names}


def broken(path):
    """What a file imports that its row does not allow."""
    row = home(path)
    if path.name == "__init__.py":
        return [f"{row}/__init__.py imports {module}: it re-exports nothing" for module, _ in imported(path)]
    allowed = OURS[row] | {row}
    file = path.relative_to(PACKAGE).with_suffix("").as_posix()
    foreign = FOREIGN[row.split("/")[0]] | ALONE.get(file, set()) | sys.stdlib_module_names
    found = []
    for module, names in imported(path):
        top = module.split(".")[0]
        if top == "freecad_am":
            found += [used for used in ours(module, names) if not allowed & {used, used.split("/")[0]}]
        elif top not in foreign:
            found.append(top)
    return [f"{file} imports {used}" for used in found]


def test_imports_run_one_way():
    assert len(modules()) > 300
    assert [told for path in modules() for told in broken(path)] == []


def test_files_that_use_more_need_it():
    for file, more in ALONE.items():
        assert more <= {module.split(".")[0] for module, _ in imported(PACKAGE / f"{file}.py")}


def test_parts_of_revolution_wait_for_no_splines_and_no_optimiser():
    """What planning them imports, in a process of its own: these parts of scipy take as long to import as all of ours."""
    used = (
        "strategies.size", "strategies.revolution", "strategies.sequence", "strategies.clearance_look", "planning.plan",
        "planning.motion", "planning.program", "process.deposit_balance", "process.support", "preflight.checks",
    )
    lines = ["import sys", *(f"import freecad_am.core.{module}" for module in used),
             "print([name for name in ('scipy.interpolate', 'scipy.optimize', 'shapely') if name in sys.modules])"]
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], cwd=PACKAGE.parent, capture_output=True, text=True,
                          check=True)
    assert done.stdout.strip() == "[]"


def test_every_row_of_the_table_exists():
    assert {home(path) for path in modules() if path.name != "__init__.py"} == set(OURS)
