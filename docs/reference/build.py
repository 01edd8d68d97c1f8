# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build the API reference as HTML from the docstrings.

The pages are generated: the list of macro functions is `freecad_am.api.__all__`, and the parameters are the modules of
`freecad_am.core.parameters`.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = (
    "freecad_am.core.issues",
    "freecad_am.core.toolpath",
    "freecad_am.core.planning.joint_path",
    "freecad_am.core.motion",
)
EXTENDING = (
    "freecad_am.core.filling.fill",
    "freecad_am.core.filling.centre",
    "freecad_am.core.geometry.regions.region",
    "freecad_am.core.kinematics.machines.machine",
    "freecad_am.core.planning.plan",
    "freecad_am.posts.catalogue",
)


def page(title: str, words: str, modules: list[str], names: dict[str, list[str]]) -> str:
    """The text of a page in reStructuredText.

    Parameters
    ----------
    title, words
        Its heading, and the sentence below it.
    modules
        Names of the modules that it documents, in this order.
    names
        Of a module, the members to document; all public ones where it has no entry.

    Returns
    -------
    str
        The page.
    """
    lines = [title, "=" * len(title), "", words, ""]
    for module in modules:
        if len(modules) > 1:
            lines += [module, "-" * len(module), ""]
        chosen = names.get(module)
        lines += [f".. automodule:: {module}"]
        lines += ["   :no-members:", ""] if chosen else [""]
        for name in chosen or ():
            lines += [f".. autofunction:: {module}.{name}", ""]
    return "\n".join(lines)


def write_pages(folder: Path) -> None:
    """Write the pages and the settings into an empty folder."""
    from freecad_am import api

    parameters = ROOT / "freecad_am" / "core" / "parameters"
    modules = [
        f"freecad_am.core.parameters.{file.stem}"
        for file in sorted(parameters.glob("*.py"))
        if not file.stem.startswith("_")
    ]
    for name in ("conf.py", "index.rst"):
        shutil.copy(HERE / name, folder)
    macros = {"freecad_am.api": list(api.__all__)}
    pages = {
        "macros": page(
            "Macros", "``from freecad_am import api as am``", ["freecad_am.api"], macros
        ),
        "parameters": page("Parameters", "What job files, properties and macros set.", modules, {}),
        "results": page("Results", "What the stages of a job hold.", list(RESULTS), {}),
        "extending": page(
            "Extending", "Where fills, machines and posts are added.", list(EXTENDING), {}
        ),
    }
    for name, text in pages.items():
        (folder / f"{name}.rst").write_text(text, encoding="utf-8")


def main(words: list[str]) -> int:
    """Build the reference.

    Parameters
    ----------
    words
        The folder to write to; `out/reference` of the project when there is none.

    Returns
    -------
    int
        0, 1 where Sphinx reports an error, 2 where it is not installed.
    """
    sys.path.insert(0, str(ROOT))
    from freecad_am.batch import host

    try:
        import numpydoc  # noqa: F401
        from sphinx.cmd.build import build_main
    except ImportError:
        print(
            "docs: Sphinx and numpydoc are missing; on Debian: "
            "apt-get install python3-sphinx python3-numpydoc",
            file=sys.stderr,
        )
        return 2
    host.find_freecad()
    target = Path(words[0]) if words else ROOT / "out" / "reference"
    with tempfile.TemporaryDirectory() as folder:
        write_pages(Path(folder))
        status = build_main(["-q", "-b", "html", folder, str(target)])
    if status == 0:
        print(target / "index.html")
    return int(status)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
