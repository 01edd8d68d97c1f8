# SPDX-License-Identifier: LGPL-2.1-or-later
"""README and docs link to existing targets, and show commands that the program accepts."""

import re
import shlex
import subprocess
from collections import Counter
from pathlib import Path

import pytest

from freecad_am.batch.cli import COMMANDS, command_parsers
from freecad_am.core.kinematics.machines import machine
from freecad_am.posts import catalogue

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
# options that the launcher handles itself, with what may follow
LAUNCHER_OPTIONS = {
    "demo": r"(-o \S+)?",
    "test": r"(--freecad 1\.[01])? ?(--long)? ?[\w/.]*",
    "docs": r"(\S+)?",
    "bench": r"(--smallest|infill|kinematics|planning|walls|whole)?",
}


def name_of(path):
    return str(path.relative_to(ROOT))


def anchors(page):
    """Return the anchors that a forge creates for the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {
        re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings
    }


def commands(page):
    """Return the words after ./freecad-am on each line of the page's shell blocks and in its inline
    code."""
    text = page.read_text(encoding="utf-8")
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        for line in block.splitlines():
            if line.startswith("./freecad-am"):
                yield shlex.split(line, comments=True)[1:]
    for line in re.findall(
        r"`\./freecad-am ([^`]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    ):
        yield shlex.split(line)


SHOWN = [(name_of(page), words) for page in PAGES for words in commands(page)]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page):
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if re.match(r"https?://|mailto:", link):
            continue
        file, _, anchor = link.partition("#")
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), f"{link} in {name_of(page)} leads nowhere"
        assert target.is_relative_to(ROOT), f"{link} leads out of the project"
        if anchor:
            assert anchor in anchors(target), f"{link} in {name_of(page)}: there is no such heading"


def test_commands_are_shown():
    assert {words[0] for page, words in SHOWN if page == "README.md"} == {
        *COMMANDS,
        *LAUNCHER_OPTIONS,
    }


@pytest.mark.parametrize(
    "page,words", SHOWN, ids=[f"{page}: {' '.join(words)}" for page, words in SHOWN]
)
def test_commands_parse(page, words):
    command, *arguments = words
    if command in LAUNCHER_OPTIONS:
        assert re.fullmatch(LAUNCHER_OPTIONS[command], " ".join(arguments)), words
        return
    assert command in COMMANDS
    if not arguments:
        return  # only the name of a command, without arguments
    options = vars(command_parsers()[1][command].parse_args(arguments))
    for value in options.values():
        if isinstance(value, str) and value.startswith(("resources/", "docs/")):
            assert (ROOT / value).is_file(), value


def test_the_launcher_tells_of_the_same_commands():
    usage = subprocess.run(
        [ROOT / "freecad-am", "--help"], capture_output=True, text=True, check=True
    ).stdout
    assert {
        line.split()[0] for line in usage.splitlines() if line.startswith("  ") and line[2] != " "
    } == {*COMMANDS, *LAUNCHER_OPTIONS}


def test_packages_are_those_the_launcher_installs():
    launcher = (ROOT / "freecad-am").read_text(encoding="utf-8")
    packages = set(" ".join(re.findall(r"_packages='(.+)'", launcher)).split())
    testing = re.search(
        r'testing_packages="\$planning_packages \$reference_packages (.+)"', launcher
    )
    packages |= set(testing[1].split())
    paragraph = (
        (ROOT / "README.md")
        .read_text(encoding="utf-8")
        .split("with `apt-get`")[1]
        .split("Elsewhere")[0]
    )
    assert set(re.findall(r"`([\w-]+)`", paragraph)) == packages


def test_tools_have_the_names_of_the_toolbar():
    gui = ROOT / "freecad_am" / "gui"
    files = [gui / "tools" / "commands.py", *sorted((gui / "families").glob("*.py"))]
    source = "".join(path.read_text(encoding="utf-8") for path in files)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    tools = re.findall(r'Tool\(\s*"\w+",\s*marked\("([^"]+)"\)', source)
    assert len(tools) == len(re.findall(r"\bTool\(", source))
    assert [
        tool for tool in tools if f"**{tool}**" not in readme and f"**[{tool}]" not in readme
    ] == []


def test_posts_and_machines_are_told():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    plain = readme.lower().replace("ä", "a").replace("ü", "u")
    assert all(f"**{post}**" in plain for post in catalogue.NAMES)
    robots = [name for name, _ in machine.known() if machine.load(name).free]
    assert f"{len(robots)} robots" in readme
    page = (ROOT / "docs/machines.md").read_text(encoding="utf-8")
    table = page.partition("| manufacturer | robots |")[2].partition("\n\n")[0]
    rows = re.findall(r"^\| (\S+?):? .*\| (\d+) \|", table, re.MULTILINE)
    ids = {"Yaskawa": "motoman", "Stäubli": "staubli", "Universal": "ur"}
    makers = Counter(name.partition("-")[0] for name in robots)
    assert {ids.get(maker, maker.lower()): int(count) for maker, count in rows} == makers


def test_columns_of_waypoints_are_told():
    from freecad_am.core.simulation import waypoints

    text = (ROOT / "docs" / "outputs.md").read_text(encoding="utf-8")
    assert all(f"`{column}`" in text for column in waypoints.HEADER.split(","))
