# SPDX-License-Identifier: LGPL-2.1-or-later
"""The window in French: tools, panels, errors, legends and docks, and FreeCAD started in French.
The window has this language during a test only."""

import os
import re
import subprocess
import tempfile
from pathlib import Path

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.inspection import InspectionParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.gui.widgets import fields
from freecad_am.gui.widgets.quantity import PlainQuantity, QuantityField
from freecad_am.objects.fields.rows import rows
from tests.window import private_home

NO_BREAK = "\u00a0"


@pytest.fixture
def french(person):
    person.gui.setLocale("French")
    person.idle(0.3)
    yield person
    for name in list(App.listDocuments()):
        App.closeDocument(name)
    person.gui.setLocale("English")
    person.idle(0.3)


def cut_off(person, form):
    """Return the labels, buttons and check boxes of a form with too little room for their texts."""
    kinds = (person.widgets.QLabel, person.widgets.QAbstractButton, person.widgets.QGroupBox)
    cut_texts = []
    for kind in kinds:
        for widget in form.findChildren(kind):
            text = widget.title() if isinstance(widget, person.widgets.QGroupBox) else widget.text()
            if not widget.isVisible() or not text:
                continue
            wraps = isinstance(widget, person.widgets.QLabel) and widget.wordWrap()
            needed = (
                widget.heightForWidth(widget.width())
                if wraps
                else widget.minimumSizeHint().height()
            )
            if widget.height() < needed or (
                not wraps and widget.width() < widget.minimumSizeHint().width()
            ):
                cut_texts.append(text)
    return cut_texts


def test_tools_say_in_french_what_is_missing(french):
    App.newDocument("Window")
    button = french.button("RoboticAM_Toolpath")
    french.until(
        lambda: re.search(r"Découpe un élément.*Créez d'abord un élément", button.toolTip()),
        "what is missing",
        5,
    )
    texts = [action.text() for action in french.gui.Command.get("RoboticAM_JointPath").getAction()]
    assert texts == ["Trajectoire articulaire…"]


def test_a_panel_its_help_and_its_errors_are_french(french, hand, hemisphere):
    french.select(hemisphere)
    french.click("RoboticAM_Feature")
    panel = french.panel("RoboticAM_RevolutionFeature")
    french.idle(0.6)
    labels = {
        label.text() for label in panel.findChildren(french.widgets.QLabel) if label.isVisible()
    }
    assert {"Source", "Axe", "Hauteur de couche", "Erreur de corde"} <= labels
    height = french.field(panel, "LayerHeight")
    assert height.toolTip() == "Distance entre couches voisines."
    assert f"Permis{NO_BREAK}: plus de 0" in height.whatsThis().replace("&nbsp;", NO_BREAK)
    choices = french.field(panel, "Wall")
    assert [choices.itemText(index) for index in range(choices.count())] == [
        "extérieure",
        "intérieure",
        "milieu",
    ]
    hand.enter(panel, "LayerHeight", "0 mm")
    french.press("Ok")
    french.until(
        lambda: "hors de la plage" in french.panel_error(panel), "the error under its field", 5
    )
    assert french.panel_error(panel) == f"0 mm est hors de la plage{NO_BREAK}; donnez plus de 0 mm"
    french.screenshot("french-feature")
    assert cut_off(french, panel) == []
    french.choose(panel, "Spacing", "le long de l'axe")
    hand.enter(panel, "LayerHeight", "2 mm")
    french.press("Ok")
    french.panel_closed()
    feature = api.stages_of(App.ActiveDocument, "feature")[0]
    assert (
        feature.Spacing == "iso-height" and feature.LayerHeight.Value == 2.0
    )  # documents are independent of the language
    assert feature.Status in ("up to date", "stale")


@pytest.fixture
def commas(french):
    """Use a FreeCAD that writes numbers in the French format."""
    original_locale = french.core.QLocale()
    of_language = french.core.QLocale("fr_FR")
    french.core.QLocale.setDefault(of_language)
    french.window.setLocale(of_language)
    yield
    french.core.QLocale.setDefault(original_locale)
    french.window.setLocale(original_locale)


def test_plain_numbers_have_the_comma_that_the_language_has(french, commas, hand, hemisphere):
    doc = hemisphere.Document
    toolpath = api.make_toolpath(
        doc, api.make_feature(doc, hemisphere, layer_height=15), temperature=150.5
    )
    french.open_workbench()
    french.double_click(toolpath)
    panel = french.panel("RoboticAM_Toolpath")
    density, temperature = french.field(panel, "Density"), french.field(panel, "Temperature")
    assert (density.text(), temperature.text()) == ("7,85", "150,5")
    hand.enter(panel, "Density", "2,7")
    hand.enter(panel, "Temperature", "120.25")
    french.press("Apply")
    french.until(lambda: toolpath.Density == 2.7, "the density", 5)
    assert toolpath.Temperature == "120.25"
    hand.enter(panel, "Density", "2,7,1")
    french.press("Ok")
    french.until(lambda: "2,7,1" in french.panel_error(panel), "the error", 5)
    hand.enter(panel, "Density", "=1.5 * 2")
    french.press("Ok")
    french.panel_closed()
    assert toolpath.Density == 3.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("7,85", "7.85"),
        (",5", ".5"),
        ("-1,5e-3 deg/mm", "-1.5e-3 deg/mm"),
        ("auto", "auto"),
        ("1,2,3", "1,2,3"),
        ("1,2 3,4 5", "1.2 3.4 5"),
        ("10,5 -,5\t30", "10.5 -.5 30"),
        ("10,5, 20", "10,5, 20"),
        ("10,5,20", "10,5,20"),
        ("1\u202f234,5", "1\u202f234,5"),
        ("1\u202f234,5 0", "1\u202f234,5 0"),
        ("=a,1", "=a,1"),
        ("12", "12"),
        ("1,5mm", "1.5mm"),
        ("", ""),
    ],
)
def test_numbers_with_blanks_between_have_their_point_changed(text, told):
    assert fields._replace_decimal_point(text, ",", ".") == told


def test_the_numbers_of_a_pose_and_a_list_have_the_comma_of_the_language(french, commas):
    lines = {}
    for cls, key, value in (
        (CellParameters, "platform", (10.5, 20.5, 30.5, 0.0, 0.0, 0.0)),
        (ProgramParameters, "origin", (1.5, 2.0, 3.0, 0.0, 0.0, 0.0)),
        (InspectionParameters, "heights", ("10.5", "20")),
    ):
        row = next(row for row in rows(cls) if row.key == key)
        field = lines[key] = fields.make(row, value)
        assert row.inner(field.value, key) == value and not field.changed
    assert lines["platform"].widget.text() == "10,5 20,5 30,5 0,0 0,0 0,0"
    assert lines["heights"].widget.text() == "10,5 20"
    for key, text, expected in (
        ("platform", "10,5 20,5 31,5", (10.5, 20.5, 31.5, 0.0, 0.0, 0.0)),
        ("platform", "100,5 mm", 100.5),
        ("platform", "1,2,3", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),
        ("platform", "10.5 20,5 3", (10.5, 20.5, 3.0, 0.0, 0.0, 0.0)),
        ("origin", "1,5 2,5 3,5", (1.5, 2.5, 3.5, 0.0, 0.0, 0.0)),
        ("heights", "10,5 20,5", ("10.5", "20.5")),
        ("heights", "10,5", ("10.5",)),
        ("heights", "10, 5, 20", ("10", "5", "20")),
    ):
        lines[key].widget.setText(text)
        assert lines[key].row.inner(lines[key].value, key) == expected, text
    for key, text in (
        ("platform", "10,5, 20,5, 3"),
        ("heights", "10,5, 20"),
        ("heights", "1\u202f234 20"),
    ):
        lines[key].widget.setText(text)
        with pytest.raises(api.InputError, match=r"is ambiguous.*10\.5 20\.5"):
            lines[key].row.inner(lines[key].value, key)


def test_a_number_of_the_language_is_read_whole_or_refused(french, commas):
    for field_class in (QuantityField, PlainQuantity):
        field = field_class(1.5, "mm", "Length")
        assert field.line.text() == "1,5 mm"
        for text, number in (("1234,5\u202fmm", 1234.5), ("12\u00a0m", 12000.0)):
            field.line.setText(text)
            field.typed = text  # the state after its keys
            assert field.read() == number, text
        for text in ("1\u202f234 mm", "1\u00a0234,5", "1’234 mm"):
            field.line.setText(text)
            field.typed = text
            with pytest.raises(api.InputError, match="do not group digits"):
                field.read()


def test_findings_and_docks_are_french(french, hemisphere):
    doc = App.ActiveDocument
    feature = api.make_feature(doc, hemisphere, layer_height=9)
    cell = api.make_cell(doc, limits="paper")
    path = api.make_joint_path(doc, api.make_toolpath(doc, feature, cell), cell)
    for command, name, words in (
        ("RoboticAM_SpinMap", "RoboticAM_SpinMap", {"Branche", "Courbe", "Degré", "Cordon"}),
        ("RoboticAM_Simulate", "RoboticAM_Simulation", {"Temps", "Masse", "Mouvements rapides"}),
    ):
        french.select(path)
        french.click(command)
        dock = french.panel(name)
        french.idle(2.0)
        shown_texts = {
            label.text().rstrip(f":{NO_BREAK}")
            for label in dock.findChildren(french.widgets.QLabel)
        }
        assert words <= shown_texts, sorted(shown_texts)
        french.screenshot(f"french-{name}")
    assert path.Message == "" or re.search(
        r" (is|are|the) ", path.Message
    )  # texts in documents stay English


def test_freecad_that_starts_in_french_shows_ours(tmp_path):
    """Another FreeCAD, with French in its preferences."""
    program = Path(f"/proc/{os.getpid()}/exe").resolve()
    script = tmp_path / "look.py"
    output_file = tmp_path / "told.txt"
    script.write_text(
        "import os\nimport FreeCADGui as Gui\nfrom PySide import QtCore\n"
        "def look():\n"
        "    Gui.activateWorkbench('RoboticAMWorkbench')\n"
        "    texts = [Gui.listWorkbenches()['RoboticAMWorkbench'].ToolTip]\n"
        "    texts += [action.text() for action in Gui.Command.get('RoboticAM_NewJob').getAction()]\n"
        f"    open({str(output_file)!r}, 'w', encoding='utf-8').write('\\n'.join(texts))\n"
        "    os._exit(0)\n"
        "QtCore.QTimer.singleShot(1000, look)\n",
        encoding="utf-8",
    )
    with tempfile.TemporaryDirectory() as folder:
        env = private_home(Path(folder))
        profile = Path(folder) / "user.cfg"
        profile.write_text(
            profile.read_text(encoding="utf-8").replace(">English<", ">French<"), encoding="utf-8"
        )
        subprocess.run(
            [str(program), str(script)], env=env, timeout=120, check=False, capture_output=True
        )
    lines = output_file.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("Couches, trajectoires articulaires et programmes vérifiés")
    assert lines[1:] == ["Nouveau travail…"]
