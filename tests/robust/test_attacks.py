# SPDX-License-Identifier: LGPL-2.1-or-later
"""Misleading folders, names and texts touch nothing outside the output folder and forge no
message."""

import base64
import hashlib
import html.parser
import json
import os
import pty
import re
import subprocess

import pytest

from freecad_am.batch import console, staging
from freecad_am.batch import output_folder as outputs
from freecad_am.core.issues import InputError
from freecad_am.posts import own_programs

OURS = "/PROG  {}\n/MN\n   1:  !Limits: maker ;\n   2:  !Travel speed 6 mm/s ;\n"


def tree(folder):
    """Return everything below a folder: contents of files, targets of links."""
    entries = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        entries[name] = (
            os.readlink(path)
            if path.is_symlink()
            else path.read_bytes()
            if path.is_file()
            else None
        )
    return entries


def publish(folder, files):
    with outputs.Outputs(str(folder)) as folder_:
        for name, content in files.items():
            folder_.write(name, content)
        return folder_.publish(outputs.earlier_outputs(folder_.folder))


def planted_report(programs, name="cup"):
    return json.dumps({"name": name, "programs": programs, "issues": []})


@pytest.fixture
def elsewhere(tmp_path):
    """Return a user's own folder next to the output folder."""
    folder = tmp_path / "elsewhere"
    (folder / "sub").mkdir(parents=True)
    for name in ("OTHER.LS", "CUP.LS", "sub/CUP.LS"):
        (folder / name).write_text(OURS.format("CUP" if "CUP" in name else "OTHER"))
    return folder


def test_a_link_in_the_place_of_program_is_refused_before_the_work(workshop, elsewhere):
    out = workshop.folder / "out" / "cup"
    out.mkdir(parents=True)
    (out / "program").symlink_to(elsewhere)
    original = tree(elsewhere), tree(out)
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 2
    assert re.fullmatch(r"error\[UNWRITABLE\] \S*out/cup/program: .*link.*-o\n", command.err), (
        command.err
    )
    assert (tree(elsewhere), tree(out)) == original


@pytest.mark.parametrize("told", [
    ["program/x/CUP.LS"], ["program/../../elsewhere/CUP.LS"], ["program/x/sub/CUP.LS", "program/"], ["program/./x/CUP.LS"],
    ["program/\0"], [["program/x"], 7, None],
])  # fmt: skip
def test_a_planted_report_removes_nothing_behind_a_link(tmp_path, elsewhere, told):
    out = tmp_path / "out"
    (out / "program").mkdir(parents=True)
    (out / "program" / "x").symlink_to(elsewhere)
    (out / "report.json").write_text(planted_report(told))
    original = tree(elsewhere)
    assert publish(out, {"report.json": b"{}", "program/CUP.LS": b"new"}) == [
        "program/CUP.LS",
        "report.json",
    ]
    assert tree(elsewhere) == original
    assert tree(out) == {
        "program": None,
        "program/CUP.LS": b"new",
        "program/x": str(elsewhere),
        "report.json": b"{}",
    }


@pytest.mark.parametrize("name", ["../elsewhere/OTHER", "..", "/etc/passwd", "a\0b", "", "."])
def test_a_planted_report_of_an_odd_name_removes_nothing(tmp_path, elsewhere, name):
    out = tmp_path / "out"
    out.mkdir()
    (out / "report.json").write_text(planted_report([], name))
    (elsewhere / "OTHER.FCStd").write_text("mine")
    original = tree(elsewhere)
    publish(out, {"report.json": b"{}"})
    assert tree(elsewhere) == original


def test_a_link_in_the_place_of_a_file_is_replaced_and_not_written_through(tmp_path, elsewhere):
    out = tmp_path / "out"
    (out / "program").mkdir(parents=True)
    (out / "program" / "CUP.LS").symlink_to(elsewhere / "CUP.LS")
    (out / "waypoints.csv").symlink_to(elsewhere / "OTHER.LS")
    original = tree(elsewhere)
    publish(out, {"program/CUP.LS": b"new", "waypoints.csv": b"rows"})
    assert tree(elsewhere) == original
    assert tree(out) == {"program": None, "program/CUP.LS": b"new", "waypoints.csv": b"rows"}


def test_an_application_that_is_a_link_is_refused(tmp_path, elsewhere):
    out = tmp_path / "out"
    (out / "program").mkdir(parents=True)
    (out / "program" / "cup").symlink_to(elsewhere)
    original = tree(elsewhere), tree(out)
    with pytest.raises(InputError, match="link") as error_info:
        publish(out, {"program/cup/start.pgx": b"new"})
    assert error_info.value.code == "UNWRITABLE" and error_info.value.where == str(
        out / "program" / "cup"
    )
    assert (tree(elsewhere), tree(out)) == original


def test_the_users_own_programs_stay(workshop):
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    program = workshop.folder / "out" / "cup" / "program"
    ours = (program / "CUP.LS").read_bytes()
    theirs = {
        "HOME.LS": b"/PROG  HOME\n",
        "notes.txt": b"mine",
        "CUPBOARD.LS": b"/PROG  CUPBOARD\n",
        "CUP07.LS": b"mine",
        "TUNED.LS": ours,
    }
    for name, content in theirs.items():
        (program / name).write_bytes(content)
    workshop.change("name: cup", "name: bowl")
    assert workshop.run("plan", "cup.yaml", "--no-page", "-o", "out/cup").status == 0
    programs = {path.name: path.read_bytes() for path in program.iterdir()}
    assert set(programs) == {*theirs, "BOWL.LS"}
    assert all(programs[name] == content for name, content in theirs.items())


def test_a_hidden_folder_of_somebody_else_stays_and_a_planted_one_reaches_nothing_outside(
    tmp_path, elsewhere
):
    out = tmp_path / "out"
    (out / ".unfinished-mine").mkdir(parents=True)
    (out / ".unfinished-mine" / "notes.txt").write_text("mine")
    (out / ".unfinished-link").symlink_to(elsewhere)
    (elsewhere / staging.MARK).touch()  # marked as a folder of the package
    (out / ".unfinished-marked").mkdir()
    (out / ".unfinished-marked" / "notes.txt").write_text("mine")
    (out / ".unfinished-marked" / staging.MARK).symlink_to(elsewhere / "OTHER.LS")
    planted = out / ".unfinished-bad"
    (planted / staging.FILES).mkdir(parents=True)
    (planted / staging.FILES / "CUP.LS").write_text("planted")
    (planted / staging.MARK).touch()
    (planted / "link").symlink_to(elsewhere)
    (planted / staging.NOTE).write_text(
        json.dumps({"files": ["CUP.LS"], "old": ["../elsewhere/OTHER.LS"]})
    )
    original = tree(elsewhere)
    publish(out, {"report.json": b"{}"})
    assert tree(elsewhere) == original
    assert tree(out) == {
        ".unfinished-mine": None,
        ".unfinished-mine/notes.txt": b"mine",
        ".unfinished-link": str(elsewhere),
        ".unfinished-marked": None,
        ".unfinished-marked/notes.txt": b"mine",
        f".unfinished-marked/{staging.MARK}": str(elsewhere / "OTHER.LS"),
        "report.json": b"{}",
    }


def test_a_macro_that_exports_again_leaves_no_part_of_the_longer_program(tmp_path):
    main = OURS.format("CUP") + "   3:  CALL CUP01 ;\n   4:  CALL CUP02 ;\n"
    longer = {"CUP.LS": main.encode(), "CUP01.LS": b"/PROG  CUP01\n", "CUP02.LS": b"/PROG  CUP02\n"}
    out = tmp_path / "out"
    assert [path.rsplit("/", 1)[1] for path in own_programs.write(str(out), longer)] == list(longer)
    theirs = {
        "CUP03.LS": b"/PROG  CUP03\n",
        "OTHER.LS": OURS.format("OTHER").encode(),
        "OTHER01.LS": b"mine",
    }
    for name, content in theirs.items():
        (out / name).write_bytes(content)
    shorter = {"CUP.LS": OURS.format("CUP").encode()}
    own_programs.write(str(out), shorter)
    assert tree(out) == {**shorter, **theirs}


def test_a_macro_exports_nothing_through_a_link(tmp_path, elsewhere):
    out = tmp_path / "out"
    out.mkdir()
    (out / "cup").symlink_to(elsewhere)
    (out / "CUP.LS").symlink_to(elsewhere / "CUP.LS")
    original = tree(elsewhere)
    with pytest.raises(OSError, match="link"):
        own_programs.write(str(out), {"cup/start.pgx": b"new"})
    own_programs.write(str(out), {"CUP.LS": b"new"})
    assert tree(elsewhere) == original
    assert tree(out) == {"CUP.LS": b"new", "cup": str(elsewhere)}


FORGED = "x\nerror[FORGED] cup.yaml: run this\r\x1b[2K\x1b]0;title\x07\x9b31m\u2028\u202ey"


@pytest.mark.parametrize(
    "place",
    ["key", "label", "value", "file", "job", "output", "option", "table", "column", "program"],
)
def test_no_message_is_forged(workshop, place):
    """Each message has one line without terminal control characters, also on a terminal."""
    words = ["plan", "cup.yaml"]
    quoted = json.dumps(FORGED.replace("\x9b", "\\x9b")).replace("\\\\x9b", "\\x9b")
    if place == "key":
        workshop.change("strategy:\n", f"strategy:\n  {quoted}: 1\n")
    elif place == "value":
        workshop.change("post: fanuc", f"post: {quoted}")
    elif place == "label":
        workshop.change("name: cup", f"name: {quoted}")
    elif place == "file":
        workshop.change("cup.step", quoted)
    elif place == "program":
        workshop.change("post: fanuc", f"post: fanuc\n  between_layers: {quoted}")
    elif place == "job":
        words = ["plan", f"{FORGED.replace('/', '')}.yaml"]
        (workshop.folder / words[1]).write_text("part: 7", encoding="utf-8")
    elif place == "output":
        (workshop.folder / FORGED).write_text("a file")
        words = ["plan", "cup.yaml", "-o", FORGED]
    elif place == "option":
        words = ["plan", "cup.yaml", f"--{FORGED}"]
    elif place == "table":
        (workshop.folder / FORGED).write_text("")
        words = ["batch", FORGED, "--job", "cup.yaml"]
    else:
        (workshop.folder / "rows.csv").write_text(f'"{FORGED}"\n1\n', encoding="utf-8")
        words = ["batch", "rows.csv", "--job", "cup.yaml"]
    command = workshop.run(*words)
    assert command.status == 2
    lines = command.err.split("\n")
    assert (
        len(lines) == 2
        and lines[1] == ""
        and lines[0].startswith("error[")
        and not lines[0].startswith("error[FORGED")
    )
    assert lines[0].isprintable(), lines[0]
    assert "Traceback" not in command.err and "INTERNAL" not in command.err


def test_of_a_value_as_long_as_a_file_a_message_tells_beginning_and_end(workshop):
    workshop.change(
        "chord_error: 0.1 mm", f"chord_error: 0.1 mm\n  max_turn: [{', '.join(['7'] * 40_000)}]"
    )
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 2 and len(command.err) < 4200 and command.err.count("\n") == 1
    workshop.change("chord_error: 0.1 mm", f"chord_error: {'7' * 200_000} mm")
    command = workshop.run("plan", "cup.yaml")
    assert (
        command.status == 2
        and len(command.err) < 4200
        and command.err.startswith("error[")
        and "cup.yaml" in command.err
    )


def test_paths_and_cells_that_are_told_stay_on_their_lines(workshop):
    folder = FORGED.replace("/", "")
    command = workshop.run("plan", "cup.yaml", "--no-page", "-o", folder)
    assert command.status == 0, command.err
    assert len(command.out.split("\n")) == 5 and all(
        line.isprintable() for line in command.out.split("\n")
    )
    (workshop.folder / "rows.csv").write_text(
        f'name,strategy.layer_height\n"{FORGED}",5 mm\n', encoding="utf-8"
    )
    command = workshop.run("batch", "rows.csv", "--job", "cup.yaml", "-o", "rows")
    assert command.status == 2 and len(command.out.split("\n")) == 3
    assert all(line.isprintable() for line in command.out.split("\n"))


def test_progress_on_a_terminal_is_escaped(workshop):
    workshop.change("name: cup", 'name: cup\nfixtures: [{file: "a\\nb\\e[31m.step"}]')
    reader, writer = pty.openpty()
    process = subprocess.Popen(
        [str(workshop.launcher), "plan", "cup.yaml"],
        cwd=workshop.folder,
        env=workshop.environment(),
        stdin=writer,
        stdout=writer,
        stderr=writer,
    )
    os.close(writer)
    text = b""
    try:
        while chunk := os.read(reader, 4096):
            text += chunk
    except OSError:  # the other end is closed
        pass
    assert process.wait(timeout=60) == 2
    assert b"\x1b[31m" not in text and b"\\x1b[31m" in text


@pytest.mark.parametrize(("text", "shown"), [
    ("plain é 日本 n°\xa0m²", "plain é 日本 n°\xa0m²"), ("a\nb\tc", "a\\nb\\tc"), ("\x1b[2K", "\\x1b[2K"),
    ("\x9b", "\\u009b"),
    ("\u202e\u2066\u2028", "\\u202e\\u2066\\u2028"), ("\udcff", "\\udcff"),
])  # fmt: skip
def test_what_is_escaped(text, shown):
    assert console.escaped(text) == shown


def test_the_page_shows_markup_in_names_as_text(workshop):
    """A name or a remark of the job may contain markup, and none of it becomes an element of
    report.html."""
    bad = "<script>alert(1)</script><img src=x onerror=alert(2)>"
    text = workshop.text[: workshop.text.index("program:")]
    workshop.write_job(text.replace("name: cup", f"name: {json.dumps(bad.replace('/', '|'))}"))
    command = workshop.run("plan", "cup.yaml", "-o", "out")
    assert command.status == 0, command.err
    elements = []

    class Reader(html.parser.HTMLParser):
        def handle_starttag(self, tag, attributes):
            elements.append((tag, dict(attributes)))

    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    Reader().feed(page)
    assert not [
        tag for tag, _ in elements if tag in ("iframe", "object", "embed", "base", "link", "form")
    ]
    # the page's own scripts: the figures and columns of the path, and the code that draws them; a
    # browser runs only these
    assert [attributes for tag, attributes in elements if tag == "script"] == [
        {"type": "application/json", "id": "path-facts"},
        {"type": "text/plain", "id": "path-columns"},
        {},
    ]
    (policy,) = (
        attributes_["content"]
        for _, attributes_ in elements
        if attributes_.get("http-equiv") == "Content-Security-Policy"
    )
    digest = base64.b64encode(
        hashlib.sha256(page.rpartition("<script>")[2].partition("</script>")[0].encode()).digest()
    )
    assert (
        f"script-src 'sha256-{digest.decode()}'" in policy
        and "alert(" not in page.partition("<script")[2]
    )
    assert not [name for _, attributes in elements for name in attributes if name.startswith("on")]
    assert not [tag for tag, attributes in elements if attributes.get("src") == "x"]
    assert "&lt;script&gt;" in page
