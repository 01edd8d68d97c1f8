# SPDX-License-Identifier: LGPL-2.1-or-later
"""Enforce the import table of docs/architecture.md: data flows one way, and host packages stay in
their folders."""

import ast
import functools
import re
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"

# folder or module -> the package's own folders and modules that it may import
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
# third-party modules that a folder may use besides the standard library
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
FILE_EXCEPTIONS = {
    "core/geometry/regions/region": {"shapely"},
    "core/one_thread": {"threadpoolctl"},
    "gui/plots/view": {"matplotlib"},
}


def modules():
    return sorted(path for path in PACKAGE.rglob("*.py") if path.stat().st_size)


def home(path):
    """Return the row of OURS that a file belongs to, such as core/slicing or posts."""
    folders = path.relative_to(PACKAGE).with_suffix("").parts
    return "/".join(folders[:2]) if folders[0] == "core" else folders[0]


@functools.cache
def tree(path):
    """Return the syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def statements(tree, typing=True):
    """Return the import statements of a syntax tree, including those in functions. Without
    `typing`, imports for type checkers only are left out."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            yield node
        elif (
            isinstance(node, ast.If)
            and not typing
            and ast.unparse(node.test).endswith("TYPE_CHECKING")
        ):
            yield from (
                statement
                for branch in node.orelse
                for statement in statements(ast.Module([branch], []), typing)
            )
        elif isinstance(node, (ast.stmt, ast.ExceptHandler, ast.match_case)):
            yield from statements(node, typing)


def imported(path, typing=True):
    """Return (module, names) of every import statement of a file; the package's own modules are
    dotted paths below the package."""
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
    """Return (module, names) of the package imports in a file outside the package. It is read as
    text, which is fast."""
    text = path.read_text(encoding="utf-8")
    for module, listed_names, single_name in re.findall(
        r"^ *from (freecad_am[\w.]*) import (?:\(([^)]*)\)|([^\n#]*))", text, re.MULTILINE
    ):
        yield (
            module,
            tuple(
                name.split()[0] for name in (listed_names or single_name).split(",") if name.strip()
            ),
        )


def ours(module, names):
    """Return the rows of OURS that a package import touches."""
    folders = module.split(".")[1:]
    if not folders:
        return set(names)
    if folders[0] != "core":
        return {folders[0]}
    return {"/".join(folders[:2])} if len(folders) > 1 else {f"core/{name}" for name in names}


def broken(path):
    """Return what a file imports that its row does not allow."""
    row = home(path)
    if path.name == "__init__.py":
        return [
            f"{row}/__init__.py imports {module}: it re-exports nothing"
            for module, _ in imported(path)
        ]
    allowed = OURS[row] | {row, "core/types"}
    file = path.relative_to(PACKAGE).with_suffix("").as_posix()
    foreign = (
        FOREIGN[row.split("/")[0]] | FILE_EXCEPTIONS.get(file, set()) | sys.stdlib_module_names
    )
    violations = []
    for module, names in imported(path):
        top = module.split(".")[0]
        if top == "freecad_am":
            violations += [
                used for used in ours(module, names) if not allowed & {used, used.split("/")[0]}
            ]
        elif top not in foreign:
            violations.append(top)
    return [f"{file} imports {used}" for used in violations]


def test_imports_run_one_way():
    assert len(modules()) > 300
    assert [violation for path in modules() for violation in broken(path)] == []


def graph():
    """Return each module of the package with the package modules that it imports, at its top or in
    a function."""
    files = {
        ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts): path for path in modules()
    }
    imports = {}
    for file, path in files.items():
        named = {
            f"{module}.{name}"
            for module, names in imported(path, typing=False)
            for name in ("", *names)
        }
        imports[file] = files.keys() & {name.rstrip(".") for name in named}
    return imports


def find_cycles(imports):
    """Return the modules on import cycles, or between two cycles: remove modules that import no
    remaining module, then modules that no remaining module imports, until nothing changes."""
    while True:
        remaining = {name: used & imports.keys() for name, used in imports.items()}
        needed = set().union(*remaining.values())
        needed_modules = {name: used for name, used in remaining.items() if used and name in needed}
        if needed_modules.keys() == imports.keys():
            return needed_modules
        imports = needed_modules


def test_no_imports_run_in_a_circle():
    """Imports in functions may not form cycles either: they exist for slow modules that are not
    always needed."""
    imports = graph()
    assert len(imports) > 600 and sum(map(len, imports.values())) > 3000
    assert find_cycles(imports) == {}


def test_circles_are_found():
    text = "if TYPE_CHECKING:\n import a\nelse:\n import b\ndef f():\n try:\n  from . import c\n except E:\n  import d"
    imported_names = [node.names[0].name for node in statements(ast.parse(text), typing=False)]
    assert imported_names == ["b", "c", "d"]
    assert find_cycles({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}) == {
        "b": {"c"},
        "c": {"b"},
    }
    assert find_cycles({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {}


def test_imports_lead_somewhere():
    """Imports in tests and benchmarks must resolve too, including those that only the window
    runs."""
    root = PACKAGE.parent
    files = {
        ".".join(path.relative_to(root).with_suffix("").parts) for path in PACKAGE.rglob("*.py")
    }
    folders = {name.removesuffix(".__init__") for name in files if name.endswith(".__init__")}
    other_files = [
        *root.glob("tests/**/*.py"),
        *root.glob("bench/**/*.py"),
        root / "InitGui.py",
        root / "Init.py",
    ]
    imports = [(path, *statement) for path in modules() for statement in imported(path)]
    imports += [(path, *statement) for path in other_files for statement in named(path)]
    wrong = []
    for path, module, names in imports:
        if module.split(".")[0] == "freecad_am":
            targets = [f"{module}.{name}" for name in names] if module in folders else [module]
            wrong += [
                f"{path.relative_to(root)} imports {name}"
                for name in targets
                if name not in files | folders
            ]
    assert len(imports) > 5000 and wrong == []


@functools.cache
def names_bound(path):
    """Return the names that a file defines, assigns or imports."""
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
    """Imported names must exist, also in the window's modules, which mypy does not check."""
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
    for file, exceptions in FILE_EXCEPTIONS.items():
        assert exceptions <= {
            module.split(".")[0] for module, _ in imported(PACKAGE / f"{file}.py")
        }


def test_parts_of_revolution_wait_for_no_splines_and_no_optimiser():
    """Planning parts of revolution must not import scipy's splines and optimiser, which take as
    long to load as the whole package. A new process checks the imports."""
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
    process = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)],
        cwd=PACKAGE.parent,
        capture_output=True,
        text=True,
        check=True,
    )
    assert process.stdout.strip() == "[]"


def test_every_row_of_the_table_exists():
    assert {home(path) for path in modules() if path.name != "__init__.py"} == set(OURS)


def test_types_of_arrays_have_one_name_each():
    """Use the array types of core/types, so that running code never loads numpy.typing."""
    named = re.compile(r"NDArray\[np\.(float64|bool_|intp|int64)\]|numpy\.typing")
    again = {
        path.relative_to(PACKAGE).as_posix()
        for path in modules()
        if named.search(path.read_text(encoding="utf-8"))
    }
    assert again == {"core/types.py"}
    look = "import sys, freecad_am.core.planning.plan; print('numpy.typing' in sys.modules)"
    process = subprocess.run(
        [sys.executable, "-c", look], cwd=PACKAGE.parent, capture_output=True, text=True, check=True
    )
    assert process.stdout.strip() == "False"
