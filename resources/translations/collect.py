# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collects all texts that the window shows, and brings the translations up to date with them.

`python3 resources/translations/collect.py` writes RoboticAM_fr.ts with the translations there are; what is new has none and
is listed. With `--release` lrelease makes RoboticAM_fr.qm of it.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

import FreeCAD  # noqa: E402, F401  first of all
import ts_file  # noqa: E402
from sources import ROOT, Code, Module, called, calls_in, files, walked  # noqa: E402
from templates import Templates  # noqa: E402

from freecad_am.core import issues  # noqa: E402
from freecad_am.core.families.registry import KINDS  # noqa: E402
from freecad_am.core.parameters import field  # noqa: E402
from freecad_am.core.parameters.place import PlaceParameters  # noqa: E402
from freecad_am.macro.features import proxy_of  # noqa: E402
from freecad_am.objects import staleness  # noqa: E402
from freecad_am.objects.cell import Cell  # noqa: E402
from freecad_am.objects.fields import preferences, properties  # noqa: E402
from freecad_am.objects.fields.rows import Row, group_of, rows  # noqa: E402
from freecad_am.objects.inspection import Inspection  # noqa: E402
from freecad_am.objects.joint_path import JointPath  # noqa: E402
from freecad_am.objects.program import Program  # noqa: E402
from freecad_am.objects.toolpath import Toolpath  # noqa: E402

LANGUAGES = ("fr",)
WINDOW, PROPERTY, COMMAND = "RoboticAM", "App::Property", "RoboticAM_{}"
STAGES = (
    Cell,
    *map(proxy_of, KINDS),
    Toolpath,
    JointPath,
    Program,
    Inspection,
)
# where messages come from that reach the window; `batch` speaks to a terminal alone
SPEAKING = (
    "core",
    "objects",
    "brep",
    "posts",
    "interop.py",
    "plots",
    "report/of_document.py",
    "gui",
    "api.py",
    "macro",
    "kdl.py",
    "read_back",
    "verify.py",
    "sections",
)
TITLES = ("core/inspection/table.py",)  # where single words are told too


class Collected:
    """All texts: those of the window, messages, and helps of properties."""

    def __init__(self) -> None:
        self.code = Code([*files(*SPEAKING), ROOT / "InitGui.py"])
        self.window: dict[str, str] = {}
        self.messages: dict[str, str] = {}
        self.properties: dict[str, str] = {}
        self.commands: dict[str, dict[str, str]] = {}
        for module in self.code.modules:
            place = module.path.relative_to(ROOT).as_posix()
            self._of_window(module, place)
            self._of_properties(module, place)
        for stage in STAGES:
            self._of_stage(stage)
        for row in rows(PlaceParameters):  # fields of a dock, of no stage
            self._of_words(row, "freecad_am/core/parameters/place.py")
        for word in (*staleness.STATUSES, issues.ERROR, issues.WARNING, issues.NOTE):
            self.messages.setdefault(word, "freecad_am/objects/staleness.py")
        for text in (
            "layer {0}",
            "layer {0} bead {1}",
            "layer {0} bead {1} point {2}",
            "layer {0} point {1}",
            "{0}: {1}",
        ):
            self.messages.setdefault(text, "freecad_am/core/issues.py")
        for row in preferences.process_rows():
            self.messages.setdefault(
                preferences.label(row), "freecad_am/objects/fields/preferences.py"
            )
        templates = Templates(self.code, TITLES)
        self.lost = templates.lost
        for template, place in templates.found.items():
            self.messages.setdefault(template, place)

    def _of_window(self, module: Module, place: str) -> None:
        """What is called `tr` or `marked`; texts of commands under the name of the command too, as FreeCAD wants them."""
        for call in calls_in(module.tree):
            if (
                called(call) in ("tr", "marked")
                and call.args
                and isinstance(call.args[0], ast.Constant)
            ):
                text = call.args[0].value
                self.window.setdefault(text, place)
                if called(call) == "marked":
                    self.messages.setdefault(text, place)
        for table in (node for node in walked(module.tree) if isinstance(node, ast.Dict)):
            for key, tool in zip(table.keys, table.values, strict=True):
                if (
                    isinstance(tool, ast.Call)
                    and called(tool) == "Tool"
                    and isinstance(key, ast.Constant)
                ):
                    calls = (
                        node
                        for node in ast.walk(tool)
                        if isinstance(node, ast.Call) and called(node) == "marked"
                    )
                    texts = [
                        call.args[0].value
                        for call in calls
                        if isinstance(call.args[0], ast.Constant)
                    ]
                    self.commands[COMMAND.format(key.value)] = dict.fromkeys(texts, place)

    def _of_properties(self, module: Module, place: str) -> None:
        """Helps beside a type of property: of `addProperty`, of figures, of options of views."""
        for node in walked(module.tree):
            parts = (
                node.args
                if isinstance(node, ast.Call)
                else node.elts
                if isinstance(node, ast.Tuple)
                else []
            )
            texts = [
                part.value
                for part in parts
                if isinstance(part, ast.Constant) and isinstance(part.value, str)
            ]
            if any(text.startswith("App::Property") for text in texts):
                for text in texts:
                    if " " in text:
                        self.properties.setdefault(text, place)

    def _of_stage(self, stage: Any) -> None:
        place = f"{stage.__module__.replace('.', '/')}.py"
        for word in (stage.kind, stage.kind.capitalize()):
            self.messages.setdefault(word, place)
        for link in stage.links:
            self.messages.setdefault(link.label, place)
            self.messages.setdefault(link.help, place)
            self.properties.setdefault(link.help, place)
            if link.required:  # 'Cell is missing; choose the cell that runs it'
                self.messages.setdefault(link.help_phrase, place)
        for section in stage.sections:
            self.messages.setdefault(section.group, place)
            for row in rows(section.cls):
                self._of_row(row, f"{section.cls.__module__.replace('.', '/')}.py")

    def _of_row(self, row: Row, place: str) -> None:
        self._of_words(row, place)
        either = ["App::PropertyFloat", "App::PropertyTime"]  # by FreeCAD's version
        for form in either if row.form == field.TIME else [properties.property_type(row, None)]:
            self.properties.setdefault(properties.tooltip(row, form), place)

    def _of_words(self, row: Row, place: str) -> None:
        nested = [group_of(row)] if len(row.path) > 1 else []
        for text in (row.label, row.spec.help, *row.spec.choices, *nested):
            self.messages.setdefault(text.replace("{", "{{").replace("}", "}}"), place)

    def texts(self) -> ts_file.Texts:
        """All of them by context, in a settled order."""
        window = {**self.messages, **self.window}
        found = {WINDOW: window, **self.commands, PROPERTY: self.properties}
        return {context: dict(sorted(some.items())) for context, some in sorted(found.items())}


def release(language: str) -> None:
    """Have lrelease make the .qm of a language."""
    source = HERE / f"RoboticAM_{language}.ts"
    subprocess.run(
        ["lrelease", "-silent", str(source), "-qm", str(source.with_suffix(".qm"))], check=True
    )


def main() -> int:
    found = Collected()
    missing = 0
    for language in LANGUAGES:
        path = HERE / f"RoboticAM_{language}.ts"
        known = ts_file.read(path)
        path.write_text(ts_file.written(found.texts(), known, language), encoding="utf-8")
        new = {source for some in found.texts().values() for source in some} - set(known)
        for source in sorted(new):
            print(f"{language}: {source}")
        missing += len(new)
        if "--release" in sys.argv:
            release(language)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
