# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damaged and hostile inputs give one message and status 2, within 10 s of processor time and 1
GB."""

import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time
import zipfile

import FreeCAD
import Part
import pytest

from freecad_am import api
from freecad_am.brep.files import sandbox, three_mf
from freecad_am.brep.files.read import read_mesh, read_shape
from freecad_am.core.issues import InputError
from freecad_am.objects.shapes import linked_files
from freecad_am.objects.shapes.part_file import part_shape
from tests.robust import damage

SECONDS, MEMORY = 10.0, 1000.0  # s of the processor, MB
CORE = three_mf.CORE
MESH = (
    '<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="9" y="0" z="0"/>'
    '<vertex x="0" y="9" z="0"/><vertex x="0" y="0" z="9"/></vertices><triangles>'
    '<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>'
    '<triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh></object>'
)
BOMB = "<?xml version='1.0' encoding='utf-8'?>\n<!DOCTYPE a [<!ENTITY b0 'lol'>{}]>\n".format(
    "".join(f"<!ENTITY b{k} '{f'&b{k - 1};' * 10}'>" for k in range(1, 10))
)


# a new process counts the memory of its parent, so a small one starts and measures the command
MEASURE = """
import json, os, subprocess, sys, threading
process = subprocess.Popen(sys.argv[2:], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
watch = threading.Timer(120.0, process.kill)
watch.start()
_, status, usage = os.wait4(process.pid, 0)
watch.cancel()
seconds, memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3
with open(sys.argv[1], "w") as stream:
    json.dump([os.waitstatus_to_exitcode(status), seconds, memory], stream)
"""


def measure(command, folder, environment):
    """Run a command and return its status, processor time in s, largest memory in MB and errors."""
    with tempfile.NamedTemporaryFile("r") as figures:
        process = subprocess.run(
            [sys.executable, "-c", MEASURE, figures.name, *command],
            cwd=folder,
            env=environment,
            stderr=subprocess.PIPE,
            text=True,
            check=True,
        )
        return (*json.load(figures), process.stderr)


def assert_refused(workshop, *words, says=""):
    """Assert one error line and status 2, within the limits, and return the line."""
    status, seconds, memory, text = measure(
        [str(workshop.launcher), *map(str, words)], workshop.folder, workshop.environment()
    )
    assert status == 2, (status, text)
    assert re.fullmatch(r"error\[[A-Z_]+\] [^\n]+\n", text) and "INTERNAL" not in text, text
    assert says in text, text
    assert seconds < SECONDS and memory < MEMORY, (seconds, memory)
    assert (
        not list(workshop.folder.rglob(".unfinished*")) and not (workshop.folder / "out").exists()
    )
    return text


def refused(function, *arguments):
    """Return the InputError of reading, within the time limit; the largest child process must be
    within the memory limit."""
    usage_before = (
        resource.getrusage(resource.RUSAGE_CHILDREN),
        resource.getrusage(resource.RUSAGE_SELF),
    )
    with pytest.raises(InputError) as error_info:
        function(*arguments)
    usage_after = (
        resource.getrusage(resource.RUSAGE_CHILDREN),
        resource.getrusage(resource.RUSAGE_SELF),
    )
    assert (
        sum(
            b.ru_utime + b.ru_stime - a.ru_utime - a.ru_stime
            for a, b in zip(usage_before, usage_after, strict=True)
        )
        < SECONDS
    )
    # the largest child of all tests in this process may be that of another file, and a new child
    # counts the memory of this process
    largest_before = max(usage.ru_maxrss for usage in usage_before) / 1e3
    assert usage_after[0].ru_maxrss / 1e3 < max(MEMORY, largest_before + 1.0)
    return error_info.value


@pytest.fixture(scope="module")
def sound(tmp_path_factory, root):
    """Return valid files by their endings."""
    folder = tmp_path_factory.mktemp("sound")
    cup = Part.makeSphere(40.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 0, 90, 360)
    cup.exportStep(str(folder / "cup.step"))
    cup.exportIges(str(folder / "cup.igs"))
    cup.exportBrep(str(folder / "cup.brep"))
    document = FreeCAD.newDocument("Sound")
    document.addObject("Part::Feature", "Cup").Shape = cup
    document.saveAs(str(folder / "cup.FCStd"))
    FreeCAD.closeDocument(document.Name)
    with zipfile.ZipFile(folder / "cup.3mf", "w") as archive:
        archive.writestr(three_mf.MODEL, model(MESH))
    return {path.suffix: path for path in folder.iterdir()}


def model(resources, items='<item objectid="1"/>'):
    return f'<model unit="millimeter" xmlns="{CORE}"><resources>{resources}</resources><build>{items}</build></model>'


def zipped(path, text):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        entry = archive.open(three_mf.MODEL, "w")
        for chunk in [text] if isinstance(text, str) else text:
            entry.write(chunk.encode())
        entry.close()
    return path


def opened(path):
    if path.suffix == ".FCStd":
        shape, _ = part_shape(str(path))
        return shape
    return read_mesh(path) if path.suffix == ".3mf" else read_shape(path)


# reading
# ---------------------------------------------------------------------------------------------------------------


def assert_read_or_refused(sound, tmp_path, damages):
    """Return how many damaged files of each ending were read and rejected; there is no other
    outcome."""
    counts = {suffix: [0, 0] for suffix in sound}
    open_before = FreeCAD.listDocuments().keys()
    for suffix, kind, seed in damages:
        path = tmp_path / f"damaged{suffix}"
        path.write_bytes(damage.damaged(sound[suffix].read_bytes(), kind, seed))
        usage_before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            opened(path)
            counts[suffix][0] += 1
        except InputError as error:
            assert error.code in ("BAD_FILE", "EMPTY_FILE", "NO_OBJECT", "UNSUPPORTED_FILE"), (
                suffix,
                kind,
                seed,
                error,
            )
            counts[suffix][1] += 1
        except Exception as error:
            raise AssertionError((suffix, kind, seed)) from error
        usage_after = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert (
            usage_after.ru_utime
            + usage_after.ru_stime
            - usage_before.ru_utime
            - usage_before.ru_stime
            < SECONDS
        ), (
            suffix,
            kind,
            seed,
        )
        assert FreeCAD.listDocuments().keys() <= open_before
    return counts


def test_damaged_files_are_read_or_refused(sound, tmp_path):
    damages = [
        (suffix, kind, seed)
        for suffix in sorted(sound)
        for kind in damage.KINDS
        for seed in range(4)
    ]
    counts = assert_read_or_refused(sound, tmp_path, damages)
    assert (
        all(count[1] for count in counts.values())
        and sum(count[0] for count in counts.values()) > 5
    ), counts


@pytest.mark.long
def test_many_damaged_files_are_read_or_refused(sound, tmp_path):
    first_seed = int(os.environ.get("ROBUST_SEED") or random.SystemRandom().randrange(1 << 30))
    print(f"seed {first_seed}: ROBUST_SEED={first_seed} makes the same damages")
    damages = [
        (suffix, kind, first_seed + n)
        for suffix in sorted(sound)
        for kind in damage.KINDS
        for n in range(25)
    ]
    print(assert_read_or_refused(sound, tmp_path, damages))


def crashing(_):
    os.abort()


def endless(_):
    while True:
        pass


def growing(_):
    chunks = []
    while True:
        chunks.append(bytearray(10_000_000))


def waiting(_):
    time.sleep(1000.0)


def wait_with_note(note):
    note.write_text(str(os.getpid()))
    time.sleep(1000.0)


@pytest.mark.parametrize(("read", "says"), [
    (crashing, "crashes"), (endless, "more than 1 s of processor time"), (growing, "more than 100 MB of memory"),
    (waiting, "more than 1 s of processor time"),
])  # fmt: skip
def test_limits_are_told(monkeypatch, tmp_path, read, says):
    monkeypatch.setattr(sandbox, "SECONDS", 1.0)
    monkeypatch.setattr(sandbox, "MEMORY", 100.0)
    monkeypatch.setattr(sandbox, "WALL_CLOCK_FACTOR", 2.0 if read is waiting else 100.0)
    error = refused(sandbox.read_in_sandbox, read, tmp_path / "part.step")
    assert (error.code, error.where) == ("BAD_FILE", "part.step") and says in error.message
    assert "export it again" in error.message


def test_a_sound_file_is_read_as_it_is_in_this_process(sound, root):
    """A valid file is read digit for digit as in this process, and nearly as fast."""
    for path in [
        sound[".step"],
        sound[".igs"],
        sound[".brep"],
        *sorted((root / "resources" / "examples").glob("*.step")),
    ]:
        local_shape = Part.Shape()
        local_shape.read(str(path))
        assert read_shape(path).exportBrepToString() == local_shape.exportBrepToString()
    usage_before = (
        resource.getrusage(resource.RUSAGE_CHILDREN),
        resource.getrusage(resource.RUSAGE_SELF),
    )
    read_shape(sound[".step"])
    usage_after = (
        resource.getrusage(resource.RUSAGE_CHILDREN),
        resource.getrusage(resource.RUSAGE_SELF),
    )
    assert (
        sum(
            b.ru_utime + b.ru_stime - a.ru_utime - a.ru_stime
            for a, b in zip(usage_before, usage_after, strict=True)
        )
        < 0.3
    )


def test_nobody_waits_for_a_copy_whose_process_was_killed(tmp_path):
    """A run that is killed while it reads leaves no process."""
    pid = os.fork()
    if not pid:
        sandbox.read_in_sandbox(wait_with_note, tmp_path / "pid")
        os._exit(0)
    until = time.monotonic() + 20.0
    while not (tmp_path / "pid").exists() or not (tmp_path / "pid").read_text():
        assert time.monotonic() < until
        time.sleep(0.01)
    os.kill(pid, 9)
    os.waitpid(pid, 0)
    copy = int((tmp_path / "pid").read_text())
    while time.monotonic() < until:
        try:
            with open(f"/proc/{copy}/stat", encoding="ascii") as stream:
                if stream.read().rpartition(")")[2].split()[0] == "Z":
                    return
        except (FileNotFoundError, ProcessLookupError):
            return
        time.sleep(0.01)
    pytest.fail("it is still there")


@pytest.mark.parametrize("number", ["1.E999", "1.E308", "-1.E300", "1.E12"])
def test_step_with_a_point_far_away(sound, tmp_path, number):
    text = sound[".step"].read_text()
    coordinates = re.findall(r"CARTESIAN_POINT\('',\(([^,)]+),", text)
    assert len(coordinates) > 3
    path = tmp_path / "far.step"
    for index in range(0, len(coordinates), max(1, len(coordinates) // 4)):
        segments = re.split(r"(?<=CARTESIAN_POINT\('',\()", text)
        segments[index + 1] = re.sub(r"^[^,)]+", number, segments[index + 1])
        path.write_text("".join(segments))
        try:
            read_shape(path)  # a point that no face needs
        except InputError as error:
            assert error.code in ("BAD_FILE", "EMPTY_FILE")


COMPONENT = '<component objectid="{}"/>'
NESTED = "".join(
    f'<object id="{k}" type="model"><components>{10 * COMPONENT.format(k - 1)}</components></object>'
    for k in range(2, 9)
)


@pytest.mark.parametrize(("text", "says"), [
    (model(MESH.replace('x="9"', 'x="1e20"')), "1e+20 mm"), (model(MESH.replace('x="9"', 'x="nan"')), "nan mm"),
    (model(MESH.replace('v3="1"', 'v3="99999999999999999999999"')), "64 bits"),
    (model(MESH + NESTED, '<item objectid="8"/>'), "objects"),
    (model(MESH, '<item objectid="1" transform="1e15 0 0 0 1e15 0 0 0 1e15 0 0 0"/>'), "mm"),
], ids=["far", "nan", "64 bits", "nested", "moved far"])  # fmt: skip
def test_three_mf_made_to_mislead(tmp_path, text, says):
    error = refused(read_mesh, zipped(tmp_path / "bad.3mf", text))
    # on a slow machine the time limit may come first, with its own message
    assert error.where == "bad.3mf" and (
        says in error.message or "more than 4 s" in error.message
    ), error


@pytest.mark.parametrize("where", ["between elements", "in an element"])
@pytest.mark.always("in an element")
def test_three_mf_of_blanks(tmp_path, where):
    blanks = " " * 1_000_000
    text_before, text_after = (
        model(MESH).split("<build>")
        if where == "between elements"
        else model(MESH).split(' objectid="1"/>')
    )
    text_after = (
        f"<build>{text_after}" if where == "between elements" else f' objectid="1"/>{text_after}'
    )
    error = refused(
        read_mesh, zipped(tmp_path / "blanks.3mf", [text_before, *[blanks] * 700, text_after])
    )
    assert error.where == "blanks.3mf" and re.search(
        "unpacks to more|longer than 4 MB", error.message
    ), error


def add_document_type(sound, path, name="Document.xml", blanks=0):
    with (
        zipfile.ZipFile(sound[".FCStd"]) as source,
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for entry in source.namelist():
            text = source.read(entry)
            if entry == name:
                body = text.decode().partition("?>")[2].replace("Cup", "&b9;")
                text = (
                    BOMB[: BOMB.index("\n")] + " " * blanks + BOMB[BOMB.index("\n") :] + body
                ).encode()
            archive.writestr(entry, text)
    return path


@pytest.mark.parametrize("blanks", [0, 200_000, 5_000_000])
def test_documents_of_entities_are_refused_before_they_are_opened(sound, tmp_path, blanks):
    path = add_document_type(sound, tmp_path / "bomb.FCStd", blanks=blanks)
    for function in (lambda: part_shape(str(path)), lambda: linked_files.opened(str(path), "bomb")):
        error = refused(function)
        assert error.code == "BAD_FILE" and (
            "document type" in error.message or "begin as XML" in error.message
        )
    assert not FreeCAD.listDocuments()


# whole commands
# --------------------------------------------------------------------------------------------------------


def test_a_document_of_entities_in_each_command(workshop, sound):
    path = add_document_type(sound, workshop.folder / "bomb.FCStd")
    assert_refused(workshop, "export", path, says="document type")
    workshop.change("cup.step", "bomb.FCStd")
    assert_refused(workshop, "plan", "cup.yaml", says="document type")
    workshop.change("{file: cup.step}", "{file: bomb.FCStd, set: {Cup: {Label: x}}}")
    assert_refused(workshop, "plan", "cup.yaml", says="document type")
    (workshop.folder / "points.csv").write_text("1,2,3\n")
    assert_refused(workshop, "inspect", path, "--measured", "points.csv", says="document type")


@pytest.mark.parametrize(("stage", "name"), [
    ("Toolpath", "FeatureProcess"), ("JointPath", "Given"), ("Cell", "Obstacles"), ("Cell", "External"),
    ("Toolpath", "Classes"),
])  # fmt: skip
@pytest.mark.always("Toolpath-FeatureProcess", "JointPath-Given", "Cell-External")
def test_texts_of_a_document(workshop, stage, name):
    """Texts stored by stages may be deeply nested or extremely long."""
    document = FreeCAD.newDocument("Texts")
    try:
        cup = document.addObject("Part::Feature", "Cup")
        cup.Shape = Part.makeSphere(40.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 0, 60, 360)
        cell = api.make_cell(document, limits="paper")
        toolpath = api.make_toolpath(
            document, api.make_feature(document, cup, layer_height=20, chord_error=1), cell
        )
        api.make_program(document, api.make_joint_path(document, toolpath, cell), name="cup")
        hostile = "[" * 200_000 + "]" * 200_000
        stored_text = getattr(document.getObject(stage), name)
        setattr(
            document.getObject(stage), name, [hostile] if isinstance(stored_text, list) else hostile
        )
        document.saveAs(str(workshop.folder / "texts.FCStd"))
    finally:
        FreeCAD.closeDocument(document.Name)
    assert len(assert_refused(workshop, "export", "texts.FCStd", says="error[BAD_VALUE]")) < 4200


def test_a_part_on_which_the_kernel_crashes(workshop, sound):
    """The kernel crashes at a reference to another entity, as in every third damaged file."""
    content = sound[".step"].read_bytes()
    for seed in range(60):
        (workshop.folder / "cup.step").write_bytes(damage.damaged(content, "references", seed))
        try:
            read_shape(workshop.folder / "cup.step")
        except InputError as error:
            if "crashes" in error.message:
                break
    else:
        pytest.skip("this kernel crashes on none of them")
    assert_refused(workshop, "plan", "cup.yaml", says="cup.step")


HUGE = "1" + "0" * 400


@pytest.mark.parametrize(("name", "content"), [
    ("nested", "[" * 200_000 + "]" * 200_000), ("long number", '{"id": ' + HUGE + "}"), ("longer number", "1" * 5000),
    ("number in a list", '{"joints": [{"origin": [' + HUGE + ', 0, 0]}]}'), ("a device", None),
], ids=["nested", "long number", "longer number", "number in a list", "a device"])  # fmt: skip
def test_machine_files(workshop, name, content):
    if content is None:
        (workshop.folder / "m.json").symlink_to("/dev/zero")
    else:
        (workshop.folder / "m.json").write_text(content)
    workshop.change("limits: paper", "machine: m.json")
    assert_refused(workshop, "plan", "cup.yaml", says="m.json")


def test_a_machine_file_with_a_number_of_400_digits(workshop, root):
    text = (root / "freecad_am" / "machines" / "fanuc-arcmate120ic.json").read_text()
    number = re.search(r"\[\s*-?\d+(?:\.\d+)?,", text)
    (workshop.folder / "m.json").write_text(
        text[: number.start()] + f"[{HUGE}," + text[number.end() :]
    )
    workshop.change("limits: paper", "machine: m.json")
    assert_refused(workshop, "plan", "cup.yaml", says="m.json")


BEADS = """\
strategy: {kind: developable, layer_height: 4 mm}
process: {bead_model: %s}
part: {file: cup.step}
"""


@pytest.mark.parametrize("table", ['"a\\0b"', "/dev/zero", "pipe", "nowhere/there.csv"])
def test_bead_models(workshop, table):
    os.mkfifo(workshop.folder / "pipe")
    workshop.write_job(BEADS % table)
    assert_refused(workshop, "plan", "cup.yaml")


@pytest.mark.parametrize("kind", ["/dev/zero", "pipe"])
def test_devices_and_pipes_in_the_place_of_files(workshop, kind):
    os.mkfifo(workshop.folder / "pipe")
    for ending in ("yaml", "csv", "step", "stl"):
        (workshop.folder / f"odd.{ending}").symlink_to(kind)
    assert_refused(workshop, "plan", "odd.yaml", says="odd.yaml")
    assert_refused(workshop, "batch", "odd.csv", "--job", "cup.yaml", says="odd.csv")
    assert_refused(workshop, "batch", "cup.yaml", "--job", "odd.yaml", says="odd.yaml")
    assert_refused(workshop, "inspect", "cup.yaml", "--measured", "odd.csv", says="device")
    workshop.change("cup.step", "odd.step")
    assert_refused(workshop, "plan", "cup.yaml", says="odd.step")


@pytest.mark.parametrize(
    "words",
    [["plan", "cup.yaml", "-o", b"\xff\xfe"], ["plan", b"cup\xff.yaml"], ["export", b"\xff.FCStd"]],
)
def test_arguments_that_are_not_utf_8(workshop, words):
    process = subprocess.run(
        [str(workshop.launcher), *words],
        cwd=workshop.folder,
        env=workshop.environment(),
        capture_output=True,
        check=False,
        timeout=60,
        stdin=subprocess.DEVNULL,
    )
    assert (
        process.returncode == 2
        and process.stderr.startswith(b"error[USAGE]")
        and b"UTF-8" in process.stderr
    )
    assert process.stderr.count(b"\n") == 1 and process.stderr.decode().strip().isprintable()
