# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pages in docs agree with the code: every key of a job with its default, and the import
table."""

import dataclasses
import functools
import importlib.util
import re
from pathlib import Path

import pytest

from freecad_am.batch.job import job
from freecad_am.core.families.registry import FAMILIES
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.place import PlaceParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.scan import ScanParameters

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
# file names in guides are relative to one of these
FILE_FOLDERS = (ROOT, ROOT / "freecad_am", ROOT / "tests")
SECTIONS = (
    *(("strategy", parameters) for parameters in [family.parameters for family in FAMILIES]),
    ("build_direction", BuildDirectionParameters),
    ("cell", CellParameters),
    ("joints", JointParameters),
    ("process", ProcessParameters),
    ("program", ProgramParameters),
    ("place", PlaceParameters),
    ("substrate", ScanParameters),
)
# keys that are not fields of a parameters dataclass
BY_HAND = {
    "version",
    "name",
    "part.file",
    "part.object",
    "part.solids",
    "part.faces",
    "part.start_edges",
    "part.edges",
    "part.scale",
    "part.set",
    "substrate",
    "substrate.scan",
    "substrate.scan_unit",
    "substrate.scan_fit",
    "substrate.scan_pairs",
    "fixtures",
    "strategy.kind",
    "strategy.guide",
    "strategy.start_faces",
    "features",
    "sequence",
    "settings[].where.layers",
    "settings[].where.height",
    "settings[].where.inside",
    "settings[].where.faces",
    "settings[].where.within",
    "settings[].process",
}
WORDS = {
    f.LENGTH: "length",
    f.ANGLE: "angle",
    f.SPEED: "speed",
    f.TIME: "time",
    f.RATIO: "percentage",
    f.NUMBER: "number",
    f.COUNT: "whole number",
    f.TEXT: "text",
    f.RECORDS: "records",
    f.VECTOR: "text",
    f.POSE: "pose",
    f.ANGLE_RANGE: "two angles",
    f.RATIO_RANGE: "two percentages",
    f.TURN_RATE: "turn",
}


def parameters(prefix, cls):
    """Return (dotted key, dataclass field) of a parameters dataclass and its groups."""
    for field in dataclasses.fields(cls):
        key = f"{prefix}.{field.name}"
        if f.spec_of(field).kind == f.GROUP:
            yield from parameters(key, field.default_factory)
        else:
            yield key, field


# a job lists settings by place beside the process, not in it
FIELDS = [
    pair
    for prefix, cls in SECTIONS
    for pair in parameters(prefix, cls)
    if pair[0] != "process.settings"
]


def default_text(spec, value):
    """Return a default in the format of a job file."""
    if spec.kind == f.VECTOR:
        return spec.records.text(value)
    if value is None:
        return "null"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        if spec.kind == f.POSE:
            value = [*value[:3], *(number / f.TO_INNER[f.ANGLE] for number in value[3:])]
        texts = [
            f.outer_text(dataclasses.replace(spec, kind=f.END_OF[spec.kind]), v)
            if spec.kind in f.END_OF
            else v
            if isinstance(v, str)
            else f"{v:.9g}"
            for v in value
        ]
        return f"[{', '.join(texts)}]"
    return f.outer_text(spec, value)


def values_text(spec, type_text):
    """Return the values that a key accepts: words, or a kind with its range."""
    if spec.kind == f.FLAG:
        return "`true`, `false`"
    if spec.kind == f.CHOICE:
        return ", ".join(f"`{word}`" for word in spec.choices)
    text = WORDS[spec.kind] + (" or pose" if spec.kind == f.LENGTH and "Pose" in type_text else "")
    if spec.low is not None:
        text += (" more than " if spec.open_low else " from ") + f.outer_text(spec, spec.low)
    if spec.high is not None:
        text += (" up to " if spec.open_low else " to ") + f.outer_text(spec, spec.high)
    words = [*spec.words, *(["null"] if spec.optional else [])]
    return text + "".join(f", or `{word}`" for word in words)


def table_rows(page):
    """Return the cells of every table row of a page whose first cell is a key."""
    for line in page.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split(" | ")]
        if line.startswith("| `") and len(cells) == 4:
            yield cells


JOB_ROWS = list(table_rows(DOCS / "job-file.md"))


@pytest.mark.parametrize("key,field", FIELDS, ids=[key for key, _ in FIELDS])
def test_every_key_of_a_job_is_documented(key, field):
    spec = f.spec_of(field)
    expected = [
        f"`{key}`",
        f"`{default_text(spec, field.default)}`",
        values_text(spec, str(field.type)),
    ]
    row = f"| {' | '.join(expected)} | {spec.help} |"
    assert expected in [cells[:3] for cells in JOB_ROWS], (
        f"docs/job-file.md lacks or contradicts the row\n{row}"
    )


def test_no_key_is_documented_that_a_job_does_not_have():
    known_keys = {key for key, _ in FIELDS} | BY_HAND
    assert {cells[0].strip("`") for cells in JOB_ROWS} - known_keys == set()
    assert {cells[0].strip("`") for cells in JOB_ROWS} >= BY_HAND


def test_sections_and_strategies_are_those_of_a_job():
    tops = {cells[0].strip("`").split(".")[0].removesuffix("[]") for cells in JOB_ROWS}
    assert tops == set(job.SECTIONS)


def test_jobs_shown_are_read(tmp_path):
    """The program accepts every YAML block of README and job-file.md that has a part."""
    blocks = [
        block
        for page in (ROOT / "README.md", DOCS / "job-file.md")
        for block in re.findall(r"```yaml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    ]
    jobs = [block for block in blocks if re.search(r"^part:", block, re.MULTILINE)]
    assert len(jobs) >= 2
    for number, block in enumerate(jobs):
        path = tmp_path / f"job{number}.yaml"
        path.write_text(block, encoding="utf-8")
        for name in re.findall(r"file: ([\w./-]+)", block):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).touch()
        job.read_job(str(path))


def imports_table():
    """Return OURS, FOREIGN and FILE_EXCEPTIONS of tests/test_imports.py."""
    spec = importlib.util.spec_from_file_location(
        "imports_table", ROOT / "tests" / "test_imports.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.OURS, module.FOREIGN, module.FILE_EXCEPTIONS


def listed(cell):
    return set(re.findall(r"`([^`]+)`", cell))


def test_architecture_has_the_table_of_imports():
    ours, foreign, alone = imports_table()
    text = (DOCS / "architecture.md").read_text(encoding="utf-8")
    section = text.split("## Who may import whom")[1].split("\n## ")[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in section.splitlines()
        if line.startswith("| `")
    ]
    shown_rows = {cells[0].strip("`"): listed(cells[1]) for cells in rows if len(cells) == 3}
    assert shown_rows == ours
    for cells in rows:
        assert listed(cells[2]) == foreign[cells[0].strip("`").split("/")[0]], cells[0]
    exceptions_text = re.search(r"Single files may import more: (.+?)\.", section)[1]
    assert {
        file: listed(modules_text)
        for file, modules_text in re.findall(r"`([^`]+)` has (`[^;]+`)", exceptions_text)
    } == alone


@functools.cache
def paths_of_rooms():
    """Return all files and folders that guides name."""
    return {path.as_posix() for room in FILE_FOLDERS for path in room.rglob("*")}


@pytest.mark.parametrize(
    "page",
    [DOCS / "architecture.md", *sorted((DOCS / "contributing").glob("*.md"))],
    ids=lambda page: page.stem,
)
def test_files_named_in_guides_exist(page):
    names = set(re.findall(r"`([\w./-]+\.py|[\w/]+/)`", page.read_text(encoding="utf-8")))
    assert names
    paths = paths_of_rooms()
    missing = [
        name
        for name in names
        if not re.search("NAME|KIND", name)
        and not any((room / name).exists() for room in FILE_FOLDERS)
        and not any(path.endswith(f"/{name.strip('/')}") for path in paths)
    ]
    assert not missing


def test_decisions_are_numbered_and_whole():
    pages = sorted((DOCS / "decisions").glob("*.md"))
    assert pages
    assert [int(path.name[:4]) for path in pages] == list(range(1, len(pages) + 1))
    for path in pages:
        text = path.read_text(encoding="utf-8")
        assert text.startswith(f"# {path.name[:4]} "), path.name
        for heading in ("**Status**", "**Context**", "**Decision**", "**Consequences**"):
            assert heading in text, f"{path.name} lacks {heading}"
        assert f"decisions/{path.name}" in (DOCS / "architecture.md").read_text(encoding="utf-8"), (
            path.name
        )


def test_every_tool_has_a_page_and_the_index_lists_it():
    gui = ROOT / "freecad_am" / "gui"
    commands_source = (gui / "tools" / "commands.py").read_text(encoding="utf-8")
    texts = [path.read_text(encoding="utf-8") for path in (gui / "families").glob("*.py")]
    ranks = {int(match[1]): text for text in texts if (match := re.search(r" rank = (\d+)", text))}
    of_features = "".join(ranks[rank] for rank in sorted(ranks))
    source = commands_source + of_features
    tools = re.findall(r'Tool\(\s*"(\w+)",\s*marked\("([^"]+)"\)', source)
    pages = [(name, f"{icon.replace('_', '-')}.md") for icon, name in tools]
    index = (DOCS / "tools" / "README.md").read_text(encoding="utf-8")
    row = r"^\| !\[\]\(\.\./\.\./resources/icons/(\w+)\.svg\) \| \[([^\]]+)\]\(([\w-]+\.md)\)"
    listed = re.findall(row, index, re.MULTILINE)
    assert sorted((name, page) for _, name, page in listed) == sorted(pages)
    assert all(page == f"{icon.replace('_', '-')}.md" for icon, _, page in listed)
    groups = re.search(r"^GROUPS = \((.*?)^\)", source, re.DOTALL | re.MULTILINE)[1]
    commands = dict(re.findall(r'"(\w+)": Tool\(\s*"(\w+)"', source))
    names = ", ".join(re.findall(r'"\w+": Tool\(', of_features))
    in_order = groups.replace(
        "*(name for window in feature_windows() for name in window.tools())", names
    )
    assert [icon for icon, _, _ in listed] == [
        commands[name] for name in re.findall(r'"(\w+)"', in_order)
    ]
    for name, page in pages:
        assert (DOCS / "tools" / page).read_text(encoding="utf-8").splitlines()[
            0
        ] == f"# {name.rstrip('…')}", page


def test_names_in_modules_that_guides_name_exist():
    """Where a module of that name exists, it must define the name in `module.name`."""
    files = {
        f"/{path.relative_to(ROOT).as_posix()}": path.read_text(encoding="utf-8")
        for folder in ("freecad_am", "tests")
        for path in (ROOT / folder).rglob("*.py")
    }
    pages = [ROOT / "CONTRIBUTING.md", *sorted((DOCS / "contributing").glob("*.md"))]
    checked, missing = set(), set()
    for page in pages:
        for module, name in re.findall(
            r"`([\w.]+)\.(?!py`)(\w+)`", page.read_text(encoding="utf-8")
        ):
            end = f"/{module.replace('.', '/')}.py"
            texts = [text for path, text in files.items() if path.endswith(end)]
            checked |= {(page.name, module, name)} if texts else set()
            if texts and not any(re.search(rf"\b{name}\b", text) for text in texts):
                missing.add((page.name, module, name))
    assert len(checked) > 5
    assert not missing
