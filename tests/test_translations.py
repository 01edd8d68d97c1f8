# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every text of the window is translatable, the French translation is complete and current, and
messages are translated by their templates."""

import ast
import gc
import inspect
import math
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.geometry.mesh.repair import repair_mesh
from freecad_am.core.issues import AmError, Issue, Text
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.preflight.promise import Promise
from freecad_am.gui.in_language import as_in_panels, in_language, names_first
from freecad_am.objects.families.recognition import Proposal, Refusal
from freecad_am.objects.results.findings import message_of
from freecad_am.objects.work import progress
from freecad_am.plots.chart import Chart, Curve, Quantity
from freecad_am.plots.pictures import Entry

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "resources" / "translations"
sys.path.insert(0, str(FOLDER))

import collect  # noqa: E402
import ts_file  # noqa: E402
from templates import MAKERS  # noqa: E402

UPDATE = "run resources/translations/collect.py, translate what it lists in RoboticAM_fr.ts, and run it with --release"
NO_BREAK = "\u00a0"
NAMED = re.compile(
    r"\b(?:part|cell|strategy|build_direction|process|joints|program|inspection)\.[a-z_.]*[a-z]"
)


@pytest.fixture(scope="module")
def collected():
    gc.disable()  # the collector would repeatedly scan the million nodes of the code
    try:
        return collect.Collected()
    finally:
        gc.enable()


@pytest.fixture(scope="module")
def french():
    return ts_file.contexts(FOLDER / "RoboticAM_fr.ts")


# ---- shipped translations


def test_all_texts_are_collected(collected, french):
    assert collected.lost == set(), (
        "f-strings that reach a message by calls: give a Text, with its values"
    )
    texts = collected.texts()
    assert len(texts["RoboticAM"]) > 1000 and len(texts["App::Property"]) > 100
    for context in texts.keys() | french.keys():
        now, shipped = set(texts.get(context, ())), set(french.get(context, ()))
        assert now == shipped, (
            f"{context}: new {sorted(now - shipped)}, gone {sorted(shipped - now)}; {UPDATE}"
        )


@pytest.mark.parametrize(
    ("made", "shown"),
    [
        (Proposal, {"reason"}),
        (Refusal, {"remark"}),
        (Promise, {"promise", "how"}),
        (Entry, {"title"}),
        (Chart, {"title"}),
        (Curve, {"name"}),
        (Quantity, {"name"}),
    ],
)
def test_texts_of_records_are_collected_from_the_fields_that_are_shown(made, shown):
    """The collector identifies them by position: a new field before them would lose their
    French."""
    names = list(inspect.signature(made).parameters)
    assert {names[position] for position in MAKERS[made.__name__]} == shown


def test_texts_that_are_whole_where_they_are_made_are_there(french):
    """The table also has single words, such as `a plane` in a message about a face."""
    complete_texts = {
        text: str(path.name)
        for path in (ROOT / "freecad_am").rglob("*.py")
        for text in re.findall(
            r'\bText\("([^"{}]*[a-z]{2}[^"{}]*)"\)', path.read_text(encoding="utf-8")
        )
    }
    assert "a plane" in complete_texts and len(complete_texts) > 10
    assert {
        text: where for text, where in complete_texts.items() if text not in french["RoboticAM"]
    } == {}


def test_french_is_complete(french):
    missing = [
        source
        for texts in french.values()
        for source, translation in texts.items()
        if not translation
    ]
    assert not missing, f"{UPDATE}: {missing}"
    assert "unfinished" not in (FOLDER / "RoboticAM_fr.ts").read_text(encoding="utf-8")
    same = {source for source, translation in french["RoboticAM"].items() if source == translation}
    words = {
        source
        for source in same
        if re.search(r"[a-z]{3,} [a-z]{3,}", re.sub(r"\{[^}]*\}", "", source))
    }
    assert not words, "not translated"


def test_places_and_accelerators_are_kept(french):
    for texts in french.values():
        for source, translation in texts.items():
            assert ts_file.fields(source) == ts_file.fields(translation), (source, translation)
            assert source.count("&") == translation.count("&"), (source, translation)
            assert (
                source[:1].isspace() == translation[:1].isspace()
                and source[-1:].isspace() == translation[-1:].isspace()
            ), source


def test_french_is_set_as_french_is(french):
    for texts in french.values():
        for translation in texts.values():
            words = re.sub(
                r"`[^`]*`|\b[a-z_]+(\.[a-z_]+)*: (?=[\[{a-z])", "", translation
            )  # settings, such as wall: outer
            assert not re.search(rf"[^{NO_BREAK}][;:?!»](?=\s|$)", words), (
                f"no space that does not break: {translation}"
            )


def test_what_lrelease_made_is_current(french):
    try:
        from PySide2 import QtCore as core
    except ImportError:
        core = pytest.importorskip("PySide6.QtCore")
    translator = core.QTranslator()
    assert translator.load(str(FOLDER / "RoboticAM_fr.qm"))
    for context, texts in french.items():
        for source, translation in texts.items():
            assert translator.translate(context, source) == translation, f"{source}; {UPDATE}"


# ---- no text of the window is left out

SHOWING = {
    "setText",
    "setToolTip",
    "setStatusTip",
    "setWhatsThis",
    "setWindowTitle",
    "setPlaceholderText",
    "setTitle",
    "setSuffix",
    "setPrefix",
    "setSpecialValueText",
    "setLabelText",
    "setHorizontalHeaderLabels",
    "setVerticalHeaderLabels",
    "addTab",
    "addAction",
    "addItem",
    "addItems",
    "addRow",
    "addButton",
    "drawText",
    "showMessage",
    "PrintError",
    "PrintWarning",
    "PrintMessage",
    "getOpenFileName",
    "getSaveFileName",
    "getExistingDirectory",
    "QLabel",
    "QPushButton",
    "QCheckBox",
    "QRadioButton",
    "QGroupBox",
    "QDockWidget",
    "QAction",
    "Tool",
    "Fold",
    "say",
    "_say",
    "tell",
    "show_note",
    "show_text",
    "_tell",
    "_show_note",
    "_show_verdict",
    "add_text",
    "heading",
    "question",
    "warning",
    "information",
    "critical",
}
TRANSLATING = {"tr", "marked", "translated", "sentence", "translated_error", "error_line"}
NAMES = {
    "mm",
    "min",
    "deg",
    "kg",
    "cm",
    "RZ",
    "URDF",
    "urdf",
    "xml",
    "csv",
    "nbsp",
    "palette",
    "text",
}
# names and icons of commands, and names of objects, which users never read
UNREAD = {"Tool": {0}, "_tell": set(), "_show_note": set()}


def bare(node: ast.AST) -> list[str]:
    """Return literal texts with words in a shown expression, outside of calls that translate."""
    if isinstance(node, ast.Call):
        name = collect.called(node)
        if name in TRANSLATING:
            return []
        inner = [node.func.value] if isinstance(node.func, ast.Attribute) else []
        return [
            text
            for operand in inner + (node.args if name == "join" else [])
            for text in bare(operand)
        ]
    if isinstance(node, ast.Constant):
        if not isinstance(node.value, str):
            return []
        words = re.findall(r"[A-Za-z]{2,}", re.sub(r"<[^>]*>|&\w+;|%[12]", " ", node.value))
        return [node.value] if set(words) - NAMES else []
    if isinstance(node, ast.Subscript):
        return bare(node.value)
    if isinstance(node, ast.Compare):
        return []
    if isinstance(node, ast.IfExp):
        return bare(node.body) + bare(node.orelse)
    return [text for child in ast.iter_child_nodes(node) for text in bare(child)]


def shown_bare(tree: ast.AST) -> list[tuple[int, str]]:
    """Return lines and texts that a file shows without translating them."""
    texts = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and collect.called(node) in SHOWING:
            name = collect.called(node)
            for position, argument in enumerate(node.args):
                if position not in UNREAD.get(name, ()):
                    texts += [(node.lineno, text) for text in bare(argument)]
    return texts


@pytest.mark.parametrize(
    "path", [*collect.files("gui"), ROOT / "InitGui.py"], ids=lambda path: path.stem
)
def test_no_text_is_shown_as_it_is_written(path):
    assert shown_bare(ast.parse(path.read_text(encoding="utf-8"))) == []


def test_texts_shown_as_they_are_written_are_found():
    text = 'a.setText("Some words")\nb.setToolTip(f"{n} layers")\nQLabel(tr("fine"))\nc.say("No" if x else tr("Yes"))\n'
    assert [line for line, _ in shown_bare(ast.parse(text + 'd.setText("{} mm".format(1))'))] == [
        1,
        2,
        4,
    ]


# ---- messages are translated by their templates


def upper(template: str) -> str:
    """Return a test language: everything except the placeholders in capitals."""
    segments = re.split(r"(\{[^}]*\})", template)
    return "".join(segment if segment.startswith("{") else segment.upper() for segment in segments)


def test_figures_and_names_stay_as_they_are():
    remedy = Text("a number such as {:.2f}", 1.5)
    assert (
        in_language(Text("{} is a mesh; use {}", "Box", remedy), upper)
        == "Box IS A MESH; USE A NUMBER SUCH AS 1.50"
    )
    assert (
        in_language(Text("{}: {}", "Cone", Text("it has {} faces", 12)), upper)
        == "Cone: IT HAS 12 FACES"
    )
    assert in_language("it has no faces", upper) == "IT HAS NO FACES"
    assert in_language("{x} is not a key", upper) == "{x} IS NOT A KEY"
    assert in_language(Text("{!r} is no key, {{}} is", "a b"), upper) == "'A B' IS NO KEY, {} IS"
    assert (
        in_language(Text("{} is not a {}", "<joint>", "joint"), upper) == "<joint> IS NOT A joint"
    )  # a word of a file
    assert in_language(Text("{} is not a {}", "Box", "cell"), upper) == "Box IS NOT A CELL"
    assert (
        in_language(Text("{} fits", "Box") + Text("; up to {} mm off", 2.5), upper)
        == "Box FITS; UP TO 2.5 MM OFF"
    )
    assert in_language("", upper) == "" and in_language(" to it ", upper) == " TO IT "


def test_a_message_that_begins_with_a_name_is_known():
    known_text, cut = Text("it has {} faces", 12), Text("{} is cut", "pipe")
    for text in (
        Text("{} is a mesh", "pipe"),
        Text("{}: {}", "pipe", known_text),
        Text("{}; use {}", cut, known_text),
    ):
        assert names_first(text), text
    for text in (
        known_text,
        Text("{} is a mesh; use a shape", "cell"),
        Text("{}; use another", known_text),
        "of none of these",
        "",
    ):
        assert not names_first(text), text


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "no bead model sets the speeds (process.bead_model)",
            "no bead model sets the speeds (“Bead model”)",
        ),
        ("use a wider strategy.band to round the layers", "use a wider “Band” to round the layers"),
        ("raise process.between_layers.lift", "raise “Between layers, lift”"),
        (
            "joints.given is of no effect; use process.seam.",
            "“Given polynomials” is of no effect; use “Seam”.",
        ),
        (
            "my/process.bead_model.csv and strategy.nothing",
            "my/process.bead_model.csv and strategy.nothing",
        ),
        ("use `motion: joint`", "use “Motion: joint”"),
        ("on the robot; use setup: tool-on-robot.", "on the robot; use “Setup: tool-on-robot”."),
        ("use path: layers, or a limit", "use “Path: layers”, or a limit"),
        ("cell.mount: feature, move", "“Mount: feature”, move"),
        ("(3, 4) and `cell.branch: auto`", "(3, 4) and “Branch: auto”"),
        ("write fill: lead 5", "write fill: lead 5"),  # the field has no such choice
        ("layers 3: a bead; my/path: layers", "layers 3: a bead; my/path: layers"),
        ("choose another joints.rotation_range", "choose another “Rotation range”"),  # two fields
        ("use `kind: solid`", "use `kind: solid`"),  # no panel has this field
        ("cell.machine.json is not a file", "cell.machine.json is not a file"),
        ("C:\\cell.machine and cell.machine\\a", "C:\\cell.machine and cell.machine\\a"),
    ],
)
def test_messages_call_parameters_as_the_panels_do(text, told):
    assert as_in_panels(text, str) == told


def test_messages_name_the_panel_that_has_the_field():
    """Read in another panel, such as New Job, the message would ask for a missing field."""
    message = as_in_panels("give process.bead_width, or `motion: joint`", str, with_panel=True)
    assert message == "give “Bead width” (Toolpath), or “Motion: joint” (Program)"


def test_parameters_in_messages_are_those_of_a_panel(collected):
    """The window knows its own label for every job key in a message, except those of job files
    only."""
    keys = {
        match[0] for text in collected.messages for match in NAMED.finditer(as_in_panels(text, str))
    }
    assert keys <= {"strategy.wait", "part.faces", "part.object", "part.scale"}


MISTAKES = {
    "out of range": lambda: RevolutionParameters(layer_height=-1.0),
    "no number": lambda: RevolutionParameters(chord_error=math.nan),
    "no choice": lambda: RevolutionParameters(spacing="even"),
    "no word": lambda: ProcessParameters(bead_model=3),
    "no machine": lambda: machine.load("fanuc-arcmate120", ()),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES.keys())
def test_errors_of_the_core_are_known(mistake, french):
    with pytest.raises(AmError) as caught:
        mistake()
    message = caught.value.message
    assert (message.template if isinstance(message, Text) else message) in french["RoboticAM"]


def test_what_was_mended_of_a_mesh_is_told_in_french(told):
    """A box without two of its triangles, with one flipped and one duplicated."""
    points = np.array([[x, y, z] for x in (0, 9) for y in (0, 9) for z in (0, 9)], dtype=float)
    faces = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
    ]
    faces[0], faces[9:] = faces[0][::-1], [faces[9], faces[9]]
    issues = repair_mesh(points, np.array(faces), "box", hole=20.0).issues
    assert {issue.code for issue in issues} == {"MESH_REPAIRED", "MENDED"}
    text = " ".join(told(issue.message) for issue in issues)
    for words in (
        "en double ont été écartés",
        "retournés pour s'accorder",
        "trous ont été bouchés",
    ):
        assert words in text
    assert not re.search(r"\b(?:were|across|triangles? .* to|holes)\b", text), text


def test_the_place_of_a_finding_is_told(told):
    assert told(Issue("error", "X", "it is there", 3, 1, 4).where) == "couche 3 cordon 1 point 4"
    assert told(Issue("error", "X", "it is there", 3, None, 4).where) == "couche 3 point 4"


# ---- messages of stages


@pytest.fixture
def told(french):
    """Return the French text of a message in a panel."""
    return lambda text: in_language(text, lambda source: french["RoboticAM"].get(source, source))


@pytest.fixture
def stages(doc):
    """Return a cell, a feature and a toolpath of them."""
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Angle1 = 0
    doc.recompute()
    cell, feature = api.make_cell(doc), api.make_feature(doc, sphere, layer_height=2)
    return SimpleNamespace(
        part=sphere, cell=cell, feature=feature, toolpath=api.make_toolpath(doc, feature, cell)
    )


def test_what_became_stale_is_told_in_french(stages, told):
    stages.feature.LayerHeight = 3
    assert told(message_of(stages.feature)) == f"LayerHeight a changé{NO_BREAK}; recalculez l'objet"
    assert told(message_of(stages.toolpath)) == f"Feature a changé{NO_BREAK}; recalculez l'objet"
    stages.toolpath.Proxy.execute(stages.toolpath)
    assert told(message_of(stages.toolpath)) == f"attend Feature{NO_BREAK}; recalculez l'objet"


def test_work_that_was_cancelled_or_overtaken_is_told_in_french(stages, told, monkeypatch):
    def cancelled(obj):
        raise progress.Cancelled

    cell, prepare = stages.cell, stages.cell.Proxy.prepare
    cell.PlatformDiameter = 100
    monkeypatch.setattr(cell.Proxy, "prepare", cancelled)
    with pytest.raises(progress.Cancelled):
        cell.Proxy.renew(cell)
    assert told(message_of(cell)) == f"annulé{NO_BREAK}; recalculez l'objet"

    def overtaken(obj):
        work = prepare(obj)
        obj.PlatformDiameter = 120
        return work

    monkeypatch.setattr(cell.Proxy, "prepare", overtaken)
    cell.Proxy.renew(cell)
    assert (
        told(message_of(cell))
        == f"une entrée a changé pendant le calcul{NO_BREAK}; recalculez l'objet"
    )


def test_a_missing_input_is_told_in_french(stages, told):
    stages.toolpath.Feature = None
    assert (
        told(message_of(stages.toolpath))
        == f"Feature manque{NO_BREAK}; choisissez l'élément à déposer"
    )
    for link in (link for stage in collect.STAGES for link in stage.links if link.required):
        text = told(Text("{} is missing; choose {}", link.name, link.help_phrase))
        assert text.startswith(f"{link.name} manque") and link.help_phrase not in text
