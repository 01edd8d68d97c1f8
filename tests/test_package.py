# SPDX-License-Identifier: LGPL-2.1-or-later
"""package.xml holds what FreeCAD's Addon Manager needs, and everything it names exists."""

import ast
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
NAMESPACE = "{https://wiki.freecad.org/Package_Metadata}"


@pytest.fixture(scope="module")
def package():
    return ElementTree.parse(ROOT / "package.xml").getroot()


def texts(node, name):
    return [(child.text or "").strip() for child in node.findall(NAMESPACE + name)]


def test_required_elements_are_there_once(package):
    assert package.tag == f"{NAMESPACE}package" and package.get("format") == "1"
    for name in ("name", "version", "date", "description", "license", "icon"):
        assert len(texts(package, name)) == 1 and texts(package, name)[0], name
    maintainers = package.findall(f"{NAMESPACE}maintainer")
    assert maintainers and all("@" in node.get("email", "") and node.text for node in maintainers)
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", texts(package, "date")[0])
    assert not re.search("freecad|workbench", texts(package, "name")[0], re.IGNORECASE)


def test_version_is_that_of_the_project_and_of_the_changelog(package):
    version = texts(package, "version")[0]
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert re.search(r'^version = "(.+)"', project, re.MULTILINE)[1] == version
    assert f"## [{version}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("hidden", ["PyKDL", "shapely", "matplotlib"])
def test_demo_installs_what_jobs_beyond_it_need(hidden):
    """The launcher installs its packages unless this Python already has every one of them."""
    boot = ROOT / "freecad_am" / "batch" / "boot.py"
    run = f"import sys, runpy; sys.modules[{hidden!r}] = None; sys.argv = ['boot.py', 'ready']; "
    run += f"runpy.run_path({str(boot)!r}, run_name='__main__')"
    assert (
        subprocess.run([sys.executable, "-c", run], capture_output=True, check=False).returncode
        == 1
    )
    launcher = (ROOT / "freecad-am").read_text(encoding="utf-8")
    installed = re.search("planning_packages='(.*)'", launcher)[1].split()
    assert (
        f"python3-{hidden.lower()}" in installed
        and "ready || provide $planning_packages" in launcher
    )


def test_no_address_is_promised_that_is_not_there(package):
    """The project has no public repository yet, so no link may lead to one. Later, package.xml
    alone names it."""
    assert package.findall(f"{NAMESPACE}url") == []
    owns = re.compile(
        r"(?:github|gitlab|codeberg)[\w./-]*/(?:freecad-am|robotic-?am)", re.IGNORECASE
    )
    pages = [
        *ROOT.glob("*.md"),
        *(ROOT / "docs").rglob("*.md"),
        *(ROOT / "freecad_am").rglob("*.py"),
        ROOT / "freecad-am",
    ]
    assert [path.name for path in pages if owns.search(path.read_text(encoding="utf-8"))] == []


def test_dependencies_are_those_of_the_window(package):
    """Every job needs numpy and scipy; solids need shapely and plots matplotlib, and say so if it
    is missing. Only commands need PyYAML, which the Addon Manager does not install."""
    (workbench,) = package.findall(f"{NAMESPACE}content/{NAMESPACE}workbench")
    depends = {
        node.text: node.get("optional") == "true"
        for node in workbench.findall(f"{NAMESPACE}depend")
    }
    assert depends == {"numpy": False, "scipy": False, "shapely": True, "matplotlib": True}
    assert {node.get("type") for node in workbench.findall(f"{NAMESPACE}depend")} == {"python"}
    launcher = (ROOT / "freecad-am").read_text(encoding="utf-8")
    assert all(f"python3-{name}" in launcher for name in depends)


def test_files_named_exist(package):
    license_node = package.find(f"{NAMESPACE}license")
    assert license_node.text == "LGPL-2.1-or-later"
    assert "LESSER GENERAL PUBLIC LICENSE" in (ROOT / license_node.get("file")).read_text(
        encoding="utf-8"
    )
    for node in package.iter(f"{NAMESPACE}icon"):
        icon = ROOT / node.text
        assert ElementTree.parse(icon).getroot().tag.endswith("svg")


def test_the_workbench_is_the_one_that_is_registered(package):
    (workbench,) = package.findall(f"{NAMESPACE}content/{NAMESPACE}workbench")
    tree = ast.parse((ROOT / "InitGui.py").read_text(encoding="utf-8"))
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    (name,) = texts(workbench, "classname")
    (menu,) = (
        node.value.value
        for node in classes[name].body
        if isinstance(node, ast.Assign) and node.targets[0].id == "MenuText"
    )
    assert texts(workbench, "name") == [menu]
    assert (ROOT / texts(workbench, "subdirectory")[0] / "InitGui.py").is_file()
    assert texts(workbench, "freecadmin") == ["0.20.2"]
    assert texts(workbench, "freecadmax") == [], (
        "a largest version hides the addon from the next release"
    )
    assert 3 <= len(texts(workbench, "tag")) <= 7
