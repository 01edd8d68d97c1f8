# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of imports of docs/architecture.md, enforced: data flows one way, hosts stay where they belong."""

import ast
import functools
import re
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"

# folder or module -> what of our own it may import besides itself
OURS = {
    "core/types": set(),
    "core/number_texts": set(),
    "core/issues": {"core/number_texts"},
    "core/program": set(),
    "core/controller": set(),
    "core/orientation": {"core/geometry"},
    "core/read_moves": set(),
    "core/motion": set(),
    "core/one_thread": set(),
    "core/parameters": {"core/issues", "core/geometry"},
    "core/geometry": {"core/issues"},
    "core/families": {"core/parameters"},
    "core/filling": {"core/issues", "core/parameters", "core/geometry"},
    "core/toolpath": {"core/families", "core/issues", "core/geometry"},
    "core/slicing": {"core/issues", "core/parameters", "core/geometry", "core/toolpath"},
    "core/layers": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
        "core/slicing",
    },
    "core/process": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/toolpath",
        "core/motion",
    },
    "core/inspection": {"core/issues", "core/parameters", "core/geometry", "core/toolpath"},
    "core/collision": {"core/geometry"},
    "core/strategies": {
        "core/families",
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
        "core/filling",
        "core/toolpath",
        "core/slicing",
        "core/layers",
        "core/process",
    },
    "core/kinematics": {
        "core/families",
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
    },
    "core/planning": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
        "core/toolpath",
        "core/kinematics",
        "core/motion",
        "core/program",
        "core/controller",
    },
    "core/simulation": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
        "core/toolpath",
        "core/kinematics",
        "core/motion",
    },
    "core/placement": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/collision",
        "core/toolpath",
        "core/kinematics",
        "core/motion",
        "core/planning",
    },
    "core/preflight": {
        "core/issues",
        "core/parameters",
        "core/geometry",
        "core/toolpath",
        "core/process",
        "core/kinematics",
        "core/motion",
        "core/simulation",
        "core/strategies",
    },
    "posts": {
        "core/issues",
        "core/controller",
        "core/orientation",
        "core/program",
        "core/read_moves",
    },
    "kdl": {"core/issues", "core/geometry", "core/kinematics"},
    "read_back": {
        "core/issues",
        "core/geometry",
        "core/kinematics",
        "core/motion",
        "core/program",
        "core/read_moves",
        "kdl",
    },
    "verify": {
        "core/issues",
        "core/geometry",
        "core/kinematics",
        "core/motion",
        "core/program",
        "core/read_moves",
        "posts",
        "read_back",
    },
    "brep": {"core/issues", "core/geometry", "core/one_thread", "core/collision"},
    "objects": {"core", "brep", "posts", "verify", "kdl"},
    "sections": {"core", "objects"},
    "interop": {"core", "objects"},
    "plots": {"core"},
    "report": {"core", "objects", "plots"},
    "macro": {"core", "objects", "posts", "interop", "report"},
    "api": {"core", "objects", "posts", "macro", "sections"},
    "batch": {
        "core",
        "api",
        "sections",
        "objects",
        "posts",
        "kdl",
        "brep",
        "read_back",
        "verify",
        "report",
    },
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
    "macro": {"FreeCAD"},
    "api": set(),
    "plots": {"numpy", "matplotlib"},
    "report": {"numpy"},
    "sections": {"FreeCAD", "yaml"},
    "batch": {"numpy", "scipy", "FreeCAD", "Part", "distributed"},
    "gui": {"numpy", "FreeCAD", "FreeCADGui", "PySide", "pivy"},
}
# single files that may use more
ALONE = {
    "core/geometry/regions/region": {"shapely"},
    "core/one_thread": {"threadpoolctl"},
    "gui/plots/view": {"matplotlib"},
}


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py") if path.stat().st_size)


def home(path):
    """The row of OURS a file belongs to, such as core/slicing or posts."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return "/".join(parts[:2]) if parts[0] == "core" else parts[0]


@functools.cache
def tree(path):
    """The syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def statements(tree, typing=True):
    """The import statements of a syntax tree, those in functions too; without `typing` none that only type checkers see."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            yield node
        elif (
            isinstance(node, ast.If)
            and not typing
            and ast.unparse(node.test).endswith("TYPE_CHECKING")
        ):
            yield from (
                found
                for other in node.orelse
                for found in statements(ast.Module([other], []), typing)
            )
        elif isinstance(node, (ast.stmt, ast.ExceptHandler, ast.match_case)):
            yield from statements(node, typing)


def imported(path, typing=True):
    """(module, names) of every import statement of a file, ours as dotted paths below the package."""
    package = ["freecad_am", *path.relative_to(PACKAGE).parts[:-1]]
    for node in statements(tree(path), typing):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, ()
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            yield (
                ".".join([*base, *(node.module or "").split(".")]).strip("."),
                tuple(alias.name for alias in node.names),
            )


def named(path):
    """(module, names) of the imports of ours in a file that is not of the package: read as text, which is quick."""
    text = path.read_text(encoding="utf-8")
    for module, many, one in re.findall(
        r"^ *from (freecad_am[\w.]*) import (?:\(([^)]*)\)|([^\n#]*))", text, re.MULTILINE
    ):
        yield module, tuple(name.split()[0] for name in (many or one).split(",") if name.strip())


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
        return [
            f"{row}/__init__.py imports {module}: it re-exports nothing"
            for module, _ in imported(path)
        ]
    allowed = OURS[row] | {row, "core/types"}
    file = path.relative_to(PACKAGE).with_suffix("").as_posix()
    foreign = FOREIGN[row.split("/")[0]] | ALONE.get(file, set()) | sys.stdlib_module_names
    found = []
    for module, names in imported(path):
        top = module.split(".")[0]
        if top == "freecad_am":
            found += [
                used for used in ours(module, names) if not allowed & {used, used.split("/")[0]}
            ]
        elif top not in foreign:
            found.append(top)
    return [f"{file} imports {used}" for used in found]


def test_imports_run_one_way():
    assert len(modules()) > 300
    assert [told for path in modules() for told in broken(path)] == []


def graph():
    """Every module of ours with those of ours that it imports, at its top or within a function."""
    files = {
        ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path for path in modules()
    }
    found = {}
    for file, path in files.items():
        named = {
            f"{module}.{name}"
            for module, names in imported(path, typing=False)
            for name in ("", *names)
        }
        found[file] = files.keys() & {name.rstrip(".") for name in named}
    return found


def on_circles(found):
    """The modules of a graph that are left over when those that import none of what is left over are taken away, and then
    those that none of these imports: modules on circles, or between two circles."""
    while True:
        left = {name: used & found.keys() for name, used in found.items()}
        needed = set().union(*left.values())
        kept = {name: used for name, used in left.items() if used and name in needed}
        if kept.keys() == found.keys():
            return kept
        found = kept


def test_no_imports_run_in_a_circle():
    """Not by imports within functions either: these are for what takes long to import and is not always needed."""
    found = graph()
    assert len(found) > 600 and sum(map(len, found.values())) > 3000
    assert on_circles(found) == {}


def test_circles_are_found():
    text = "if TYPE_CHECKING:\n import a\nelse:\n import b\ndef f():\n try:\n  from . import c\n except E:\n  import d"
    seen = [node.names[0].name for node in statements(ast.parse(text), typing=False)]
    assert seen == ["b", "c", "d"]
    assert on_circles({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}) == {
        "b": {"c"},
        "c": {"b"},
    }
    assert on_circles({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {}


def test_imports_lead_somewhere():
    """Those of tests and benchmarks too, which the window alone or nobody runs."""
    root = PACKAGE.parent
    files = {
        ".".join(path.relative_to(root).with_suffix("").parts) for path in PACKAGE.rglob("*.py")
    }
    folders = {name.removesuffix(".__init__") for name in files if name.endswith(".__init__")}
    others = [
        *root.glob("tests/**/*.py"),
        *root.glob("bench/**/*.py"),
        root / "InitGui.py",
        root / "Init.py",
    ]
    found = [(path, *one) for path in modules() for one in imported(path)]
    found += [(path, *one) for path in others for one in named(path)]
    wrong = []
    for path, module, names in found:
        if module.split(".")[0] == "freecad_am":
            asked = [f"{module}.{name}" for name in names] if module in folders else [module]
            wrong += [
                f"{path.relative_to(root)} imports {name}"
                for name in asked
                if name not in files | folders
            ]
    assert len(found) > 5000 and wrong == []


@functools.cache
def names_bound(path):
    """The names that a file defines, assigns or imports anywhere."""
    names = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.alias):
            names.add(node.asname or node.name.split(".")[0])
    return names


def test_imported_names_exist():
    """Those of the window too, which mypy does not read."""
    root = PACKAGE.parent
    missing, count = [], 0
    for path in modules():
        for module, names in imported(path):
            file = root.joinpath(*module.split(".")).with_suffix(".py")
            if not module.startswith("freecad_am.") or not file.exists():
                continue
            count += len(names)
            if "__getattr__" not in names_bound(file):
                missing += [
                    f"{path.relative_to(root)}: {module}.{name}"
                    for name in names
                    if name not in names_bound(file)
                ]
    assert count > 2000 and missing == []


def test_files_that_use_more_need_it():
    for file, more in ALONE.items():
        assert more <= {module.split(".")[0] for module, _ in imported(PACKAGE / f"{file}.py")}


def test_parts_of_revolution_wait_for_no_splines_and_no_optimiser():
    """What planning them imports, in a process of its own: these parts of scipy take as long to import as all of ours."""
    used = (
        "strategies.estimated_size",
        "strategies.revolution.plan",
        "strategies.sequence",
        "strategies.clearance.nozzle_check",
        "planning.plan",
        "planning.motion",
        "planning.program",
        "process.deposit.balance",
        "process.deposit.support",
        "preflight.checks",
    )
    lines = [
        "import sys",
        *(f"import freecad_am.core.{module}" for module in used),
        "print([name for name in ('scipy.interpolate', 'scipy.optimize', 'shapely') if name in sys.modules])",
    ]
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)],
        cwd=PACKAGE.parent,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "[]"


def test_every_row_of_the_table_exists():
    assert {home(path) for path in modules() if path.name != "__init__.py"} == set(OURS)


def test_types_of_arrays_have_one_name_each():
    """The names of core/types, which nothing that runs loads numpy.typing for."""
    named = re.compile(r"NDArray\[np\.(float64|bool_|intp|int64)\]|numpy\.typing")
    again = {
        path.relative_to(PACKAGE).as_posix()
        for path in modules()
        if named.search(path.read_text(encoding="utf-8"))
    }
    assert again == {"core/types.py"}
    look = "import sys, freecad_am.core.planning.plan; print('numpy.typing' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", look], cwd=PACKAGE.parent, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"
