# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every parameter of every dataclass goes into a document object and comes back the same."""

import copy
import dataclasses
import math
import random
import re

import FreeCAD as App
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.filled import (
    CladdingParameters,
    DevelopableParameters,
    SolidParameters,
)
from freecad_am.core.parameters.inspection import InspectionParameters
from freecad_am.core.parameters.joints import METHODS, JointParameters
from freecad_am.core.parameters.place import PlaceParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.scan import ScanParameters
from freecad_am.core.parameters.strategy import (
    CurvesParameters,
    RevolutionParameters,
    SurfaceParameters,
)
from freecad_am.objects.curves_feature import CurvesFeature
from freecad_am.objects.fields import properties, quantities, rows
from freecad_am.objects.stage_parts import Section
from freecad_am.sections import fields as sections

CLASSES = (
    (CellParameters, "cell"),
    (RevolutionParameters, "strategy"),
    (BuildDirectionParameters, "build_direction"),
    (ProcessParameters, "process"),
    (JointParameters, "joints"),
    (ProgramParameters, "program"),
)
FAMILIES = (
    (DevelopableParameters, "strategy"),
    (SolidParameters, "strategy"),
    (CladdingParameters, "strategy"),
    (SurfaceParameters, "strategy"),
    (CurvesParameters, "strategy"),
    (InspectionParameters, "inspection"),
    (PlaceParameters, "place"),
    (ScanParameters, "scan"),
)
TEXTS = {
    "machine": "staubli-rx60bl",
    "limits": "paper",
    "call": "CLEAN",
    "gas": "argon 4.6",
    "bead_model": "csw",
    "shape": "torch.step",
    "name": "ER 2319",
    "source": "l'essai n° 7",
    "post": "siemens",
    "plane": "0.6 0 -0.8",
    "deposit_on": "M7",
    "deposit_off": "H2=0",
    "unit": "STN1",
    "external": "motoman-motopos-d500 at 1500 0.25 -3 0 45 0 carries part",
    "world_up": "0 0.1 1",
    "point": "40 -0.5 12.25",
    "away_from": "0.5 -1 0",
    "classes": "first_layer: travel_speed 4.5, schedule 2; fill: lead -5, lead_on 0.25, weave 2",
    "settings": "layers 0 to 4: travel_speed 4.5, schedule 3; height to 5 and inside Zone: lead_on 0.5",
    "obstacles": "post = box 60 60 400 at 900 -0.25 0 0 30 0",
    "touched": "0 0 0 = 900.5 2 -99; 9 0 0.25 = 909 2 -99",
}


@pytest.fixture
def holder(doc):
    obj = doc.addObject("App::FeaturePython", "Holder")
    obj.Label = "Héros n° 1"
    return obj


def random_number(spec, rng):
    widest = math.pi if spec.kind == f.ANGLE else 1000.0
    low = spec.low if spec.low is not None else -widest
    high = spec.high if spec.high is not None else max(low, 0.0) + widest
    if spec.kind == f.COUNT:
        return rng.randint(int(low), int(min(high, low + 500)))
    return rng.uniform(low, high)


def random_value(row, rng):
    spec = row.spec
    if row.form == f.POSE:
        return tuple(rng.uniform(-1500, 1500) for _ in range(3)) + tuple(
            rng.uniform(-1.5, 1.5) for _ in range(3)
        )
    if row.form == rows.LENGTH_OR_POSE:
        pose = tuple(rng.uniform(-50, 50) for _ in range(6))
        return rng.choice([rng.uniform(0, 50), pose])
    if row.key == "given":
        texts = [f"{k}/0:{rng.uniform(-180, 180):.6g}:360" for k in range(rng.randint(0, 3))]
        return row.spec.records.read(texts)
    if row.form == rows.TEXT_LIST:
        return tuple(rng.sample(METHODS, rng.randint(0, len(METHODS))))
    if row.key == "origin":
        return rng.choice(["auto", tuple(rng.uniform(-3, 3) for _ in range(6))])
    if row.key == "branch":
        return rng.choice(["auto", ("back", "down", "noflip"), ("front", "up", "flip")])
    if spec.optional and rng.random() < 0.3:
        return None
    if spec.words and rng.random() < 0.3:
        return rng.choice(spec.words)
    if spec.kind == f.CHOICE:
        return rng.choice(spec.choices)
    if spec.kind == f.FLAG:
        return rng.random() < 0.5
    if spec.kind in (f.RECORDS, f.VECTOR):
        return spec.records.read(TEXTS[row.path[-1]])
    if spec.kind == f.TEXT:
        return TEXTS[row.path[-1]]
    return random_number(spec, rng)


def random_parameters(cls, rng):
    values = {row.key: random_value(row, rng) for row in rows.rows(cls)}
    for key in [key for key in values if key.endswith("_low") and key[:-4] + "_high" in values]:
        values[key[:-4] + "_high"] = values[key] + rng.uniform(0.1, math.pi)
    return rows.build(cls, values)


def assert_same(one, other):
    have, want = rows.flat(one), rows.flat(other)
    assert have.keys() == want.keys()
    for key in want:
        if isinstance(want[key], float) or (
            isinstance(want[key], tuple) and key != "branch" and want[key][:1] != ()
        ):
            assert have[key] == pytest.approx(want[key], rel=1e-13, abs=1e-12), key
        else:
            assert have[key] == want[key] and type(have[key]) is type(want[key]), key


@pytest.mark.parametrize(("cls", "section"), CLASSES)
def test_defaults_come_back_equal(holder, cls, section):
    properties.add(holder, cls, "Group")
    assert properties.read(holder, cls, section) == cls()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("cls", "section"), CLASSES)
def test_random_values_come_back_also_from_a_file(doc, holder, tmp_path, cls, section, seed):
    rng = random.Random(seed * 100 + len(section))
    parameters = random_parameters(cls, rng)
    properties.add(holder, cls, "Group")
    properties.write(holder, parameters)
    assert_same(properties.read(holder, cls, section), parameters)
    mark = properties.fingerprint(holder, cls)
    doc.saveAs(str(tmp_path / "p.FCStd"))
    again = App.openDocument(str(tmp_path / "p.FCStd")).getObject("Holder")
    try:
        assert_same(properties.read(again, cls, section), parameters)
        assert properties.fingerprint(again, cls) == mark
    finally:
        App.closeDocument(again.Document.Name)


@pytest.mark.parametrize("cls", [cls for cls, _ in CLASSES])
def test_every_field_of_the_dataclass_has_a_row_and_rows_have_different_names(cls):
    def leaves(kind):
        for field in dataclasses.fields(kind):
            spec = f.spec_of(field)
            if spec.kind == f.GROUP:
                yield from leaves(field.default_factory)
            else:
                yield from [field.name] * (2 if spec.kind in f.END_OF else 1)

    names = [row.name for row in rows.rows(cls)]
    assert len(names) == len(set(names)) == len(list(leaves(cls)))
    assert rows.build(cls, {}) == cls()


def test_units_of_properties(holder):
    for cls, _ in CLASSES:
        properties.add(holder, cls, "Group")
    holder.LayerHeight = "0.1 cm"
    holder.TravelSpeed = "360 mm/min"
    holder.NozzleHalfAngle = "0.1 rad"
    holder.Rz = "90 deg"
    holder.Platform = "0 0 12 0 0 90"
    holder.DepositionPoint = App.Placement(
        App.Vector(1, 2, 3), App.Rotation(App.Vector(0, 1, 0), 30)
    )
    assert properties.read(holder, RevolutionParameters, "strategy").layer_height == pytest.approx(
        1.0
    )
    assert properties.read(holder, ProcessParameters, "process").travel_speed == pytest.approx(6.0)
    cell = properties.read(holder, CellParameters, "cell")
    assert cell.nozzle.half_angle == pytest.approx(0.1)
    assert cell.platform == pytest.approx((0, 0, 12, 0, 0, math.pi / 2))
    assert cell.deposition_point == pytest.approx((1, 2, 3, 0, math.radians(30), 0))
    assert properties.read(holder, JointParameters, "joints").rz == pytest.approx(math.pi / 2)
    assert "(mm)" in holder.getDocumentationOfProperty("Platform")
    assert holder.getGroupOfProperty("LayerHeight") == "Group"


@pytest.mark.parametrize(
    ("cls", "section", "name", "value", "code"),
    [
        (RevolutionParameters, "strategy", "LayerHeight", 0, "BAD_VALUE"),
        (JointParameters, "joints", "Rz", "some", "BAD_VALUE"),
        (JointParameters, "joints", "Rz", "3 mm", "BAD_UNIT"),
        (JointParameters, "joints", "MinCondition", "1.5", "BAD_VALUE"),
        (JointParameters, "joints", "Degree", 99, "BAD_VALUE"),
        (JointParameters, "joints", "Compare", ["nothing"], "BAD_VALUE"),
        (CellParameters, "cell", "Branch", "front sideways flip", "BAD_VALUE"),
        (CellParameters, "cell", "Platform", "1,5 mm", "BAD_VALUE"),
        (CellParameters, "cell", "Platform", "10,5 20,5 30,5", "BAD_VALUE"),
        (CellParameters, "cell", "Platform", "1\u202f234 mm", "BAD_VALUE"),
        (JointParameters, "joints", "Rz", "1\u00a0234 deg", "BAD_VALUE"),
        (JointParameters, "joints", "Rz", "1’234 deg", "BAD_VALUE"),
        (CellParameters, "cell", "NozzleLength", 0, "BAD_VALUE"),
        (ProcessParameters, "process", "BetweenLayersInput", "1.5", "BAD_VALUE"),
        (ProcessParameters, "process", "StandOff", "2 deg", "BAD_UNIT"),
        (ProgramParameters, "program", "StartAtLayer", -1, "BAD_VALUE"),
    ],
)
def test_bad_values_name_label_and_property(holder, cls, section, name, value, code):
    properties.add(holder, cls, "Group")
    setattr(holder, name, value)
    with pytest.raises(InputError) as caught:
        properties.read(holder, cls, section)
    assert caught.value.code == code
    assert caught.value.where == f"Héros n° 1.{name}"


@pytest.mark.parametrize(
    ("text", "seconds"), [("50 ms", 0.05), (" 7.5ms", 0.0075), ("0.05 s", 0.05), ("0.05", 0.05)]
)
def test_times_may_be_in_milliseconds(text, seconds):
    lead = next(row for row in rows.rows(ProgramParameters) if row.key == "trigger_lead")
    assert lead.inner(text, "program.trigger_lead") == pytest.approx(seconds, rel=1e-15)
    stand_off = next(row for row in rows.rows(ProcessParameters) if row.key == "stand_off")
    with pytest.raises(InputError, match="is a time; give a length"):
        stand_off.inner("50 ms", "process.stand_off")


@pytest.mark.parametrize(
    ("text", "says"),
    [("0,05", "as in 0.05"), ("0,05 s", "as in 0.05 s"), (",5s", "as in .5s")],
)
def test_a_decimal_comma_is_told_how_to_be_written(text, says):
    lead = next(row for row in rows.rows(ProgramParameters) if row.key == "trigger_lead")
    with pytest.raises(InputError, match=f"has a comma; use a decimal point, {says}$"):
        lead.inner(text, "program.trigger_lead")


@pytest.mark.parametrize(
    "cls", [cls for cls, _ in (*CLASSES, (SolidParameters, ""), (CladdingParameters, ""))]
)
def test_the_example_of_a_message_may_be_entered(cls):
    for row in rows.rows(cls):
        if (
            row.spec.kind in quantities.WANTED
            and quantities.WANTED[row.spec.kind][0] != quantities.NONE
        ):
            with pytest.raises(InputError) as caught:
                row.inner("1 kg", row.key)
            found = re.search(r"such as ([^ ]+ [^ ]+)", str(caught.value.message))
            f.check_value(row.spec, row.inner(found[1], row.key), row.key)


@pytest.mark.parametrize(
    "text",
    ["10,5 20,5", "10,5, 20,5", "10, 5,5", "10,5 mm", ",5 20", ",5", "1\u202f234", "1 2\u00a0345"],
)
def test_a_list_that_may_be_read_in_two_ways_is_refused(text):
    heights = next(row for row in rows.rows(InspectionParameters) if row.key == "heights")
    with pytest.raises(
        InputError,
        match=r"is ambiguous; write decimals with a point .* as in 10\.5 20\.5",
    ):
        heights.inner(text, "inspection.heights")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("10, 5, 20", "10 5 20"),
        ("10,5,20", "10 5 20"),
        ("10.5,20.5", "10.5 20.5"),
        ("10.5 20 , 5", "10.5 20 5"),
        ("\u00a010.5\u202f mm ", "10.5 mm"),
        ("0/0:1.5:-2 *:0", "0/0:1.5:-2 *:0"),
        ("", ""),
    ],
)
def test_a_list_has_blanks_or_commas_between(text, words):
    heights = next(row for row in rows.rows(InspectionParameters) if row.key == "heights")
    assert heights.inner(text, "inspection.heights") == tuple(words.split())


@pytest.mark.parametrize(
    "text", ["12\u202fm", "12\u00a0m", "12 m", "1.2e7\u2009\u03bcm", "1.2e7 \u00b5m"]
)
def test_a_quantity_may_have_any_blank_before_its_unit(text):
    assert quantities.quantity(text).getValueAs("mm").Value == pytest.approx(12000.0)


@pytest.mark.parametrize(
    "text", ["1\u202f234 mm", "1\u00a0234 mm", "1\u2009234", "1’234 mm", "2 mm²", "5 мм", "１２ mm"]
)
def test_a_quantity_is_read_whole_or_not_at_all(text):
    with pytest.raises((ValueError, OSError)):
        quantities.quantity(text)


@pytest.mark.parametrize("text", ["[", "2 mm [about"])
def test_a_quantity_that_ends_within_a_comment_does_not_spoil_the_next_ones(text):
    with pytest.raises((ValueError, OSError)):
        quantities.quantity(text)
    assert quantities.quantity("2 cm").getValueAs("mm").Value == pytest.approx(20.0)


def test_an_angle_that_freecad_would_cut_is_refused(holder):
    properties.add(holder, ProcessParameters, "Group")
    with pytest.raises(InputError, match="720 deg is out of range"):
        properties.write(holder, rows.build(ProcessParameters, {"seam_angle": 4 * math.pi}))


def test_old_objects_get_the_properties_they_lack_and_keep_the_others(holder):
    holder.addProperty("App::PropertyLength", "LayerHeight", "Group", "").LayerHeight = 3.0
    holder.addProperty("App::PropertyEnumeration", "Spacing", "Group", "")
    holder.Spacing = ["iso-height", "some old way"]
    holder.addProperty("App::PropertyEnumeration", "Wall", "Group", "")
    holder.Wall = ["gone"]
    properties.add(holder, RevolutionParameters, "Group")
    want = RevolutionParameters(layer_height=3.0, spacing="iso-height")
    assert properties.read(holder, RevolutionParameters, "strategy") == want
    properties.add(holder, RevolutionParameters, "Group")
    assert properties.read(holder, RevolutionParameters, "strategy") == want


def test_a_wire_feed_of_an_older_document_keeps_its_number_and_may_become_auto(holder):
    """It was a speed and is a text by now; opening the document changes neither value nor type nor fingerprint."""
    holder.addProperty("App::PropertySpeed", "WireFeed", "Group", "").WireFeed = 10.0
    properties.add(holder, ProcessParameters, "Group")
    assert properties.read(holder, ProcessParameters, "process").wire.feed == 10.0
    assert holder.getTypeIdOfProperty("WireFeed") == "App::PropertySpeed"
    assert "WireFeed=10" in properties.fingerprint(holder, ProcessParameters)
    properties.write(holder, rows.build(ProcessParameters, {"wire_feed": 12.5}))
    assert properties.read(holder, ProcessParameters, "process").wire.feed == 12.5
    properties.write(holder, ProcessParameters())
    assert holder.WireFeed == "auto" and holder.getGroupOfProperty("WireFeed") == "Group"
    assert properties.read(holder, ProcessParameters, "process").wire.feed == "auto"


# what some keys need: a value of their own, or another key beside them
JOB_NUMBERS = {"spacing_range_high": 1.4, "spacing_range_low": 0.7, "step": 200.0}
JOB_COMPANIONS = {("strategy", "base_height"): {"base": {"radius": 50.0}}}
JOB_COMPANIONS["inspection", "side"] = {"thickness": 2.0}
NOT_FOR_CLADDING = ("solid_layers", "margin")


def job_section(row, spelling, name):
    """The section of a job file that gives one key, the other end of a range at its default."""
    value = spelling
    if isinstance(row.path[-1], int):
        ends = list(default_range(row))
        ends[row.path[-1]] = spelling
        value = ends
    section = copy.deepcopy(JOB_COMPANIONS.get((name, row.key), {}))
    steps = [step for step in row.path if isinstance(step, str)]
    inner = section
    for step in steps[:-1]:
        inner = inner.setdefault(step, {})
    inner[steps[-1]] = value
    return section


def default_range(row):
    """The default ends, in outer units, of the range that a row is an end of."""
    for cls, _ in (*CLASSES, *FAMILIES):
        ends = {each.path: each for each in rows.rows(cls)}
        if row in ends.values():
            return tuple(row.outer(ends[(*row.path[:-1], end)].default) for end in (0, 1))
    raise AssertionError(row)


def job_number(row):
    """A number in inner units that is allowed and not the default."""
    if row.key in JOB_NUMBERS:
        return JOB_NUMBERS[row.key]
    spec = row.spec
    step = {f.ANGLE: math.radians(7.0), f.TURN_RATE: math.radians(7.0), f.RATIO: 0.07}
    low = spec.low if spec.low is not None else 0.0
    value = low + step.get(spec.kind, 3)
    if spec.high is not None and value > spec.high:
        value = 0.5 * (low + spec.high)
    return value if value != row.default else value + step.get(spec.kind, 1)


def job_values(row):
    if row.spec.kind == f.FLAG:
        return [not row.default]
    if row.spec.kind == f.CHOICE:
        return [choice for choice in row.spec.choices if choice != row.default]
    words = [word for word in row.spec.words if word not in (row.default, "inf")]
    return [job_number(row), *words]


def spellings(row, value):
    """What a job file may have for a value: the word, the bare number, and texts with the unit."""
    if row.spec.kind in (f.CHOICE, f.FLAG) or isinstance(value, str):
        return [value]
    shown = row.outer(value)
    return [shown, f"{shown} {row.unit}", f"{shown}{row.unit}"] if row.unit else [shown]


def job_cases():
    for cls, section in (*CLASSES, *FAMILIES):
        for row in rows.rows(cls):
            plain_text = (
                row.spec.kind in (f.TEXT, f.POSE, f.RECORDS, f.VECTOR) or row.form == rows.TEXT_LIST
            )
            if not plain_text and not (cls is CladdingParameters and row.key in NOT_FOR_CLADDING):
                yield pytest.param(cls, section, row, id=f"{cls.__name__}-{row.key}")


@pytest.mark.parametrize(("cls", "section", "row"), job_cases())
def test_every_key_of_a_job_file_reaches_the_core_by_its_property(holder, cls, section, row):
    """With a value that is not the default, in each spelling; a macro takes the same spellings."""
    properties.add(holder, cls, "Group")
    for value in job_values(row):
        for spelling in spellings(row, value):
            parameters = sections.build(cls, job_section(row, spelling, section), section)
            properties.write(holder, parameters)
            again = properties.read(holder, cls, section)
            assert_same(again, parameters)
            reached = rows.flat(again)[row.key]
            assert reached == (pytest.approx(value, rel=1e-12) if type(value) is float else value)
            assert row.inner(spelling, row.key) == pytest.approx(reached, rel=1e-15)


@pytest.mark.parametrize("text", ["20 %", "20%", " 20.0 % ", "20", "2e1 %", 20, 20.0])
@pytest.mark.parametrize("key", ["bead_overlap", "fill_density", "gap", "spacing_range_low"])
def test_a_percentage_may_be_written_with_its_sign_or_without(text, key):
    row = next(row for row in rows.rows(SolidParameters) if row.key == key)
    assert row.inner(text, key) == pytest.approx(0.2, rel=1e-15)


@pytest.mark.parametrize("text", ["20 %%", "%", "twenty", "20 mm", "20 % of it", ""])
def test_what_is_no_percentage_is_rejected_with_an_example(text):
    row = next(row for row in rows.rows(SolidParameters) if row.key == "fill_density")
    with pytest.raises(InputError, match="give a percentage such as 20 %"):
        row.inner(text, "fill_density")


def test_a_percentage_in_a_property_has_no_digits_of_rounding(holder):
    properties.add(holder, SolidParameters, "Group")
    for percent in range(1, 90):
        properties.write(holder, rows.build(SolidParameters, {"bead_overlap": percent * 0.01}))
        assert holder.BeadOverlap == f"{float(percent)} %"


def test_records_are_stored_as_json_and_read_from_older_texts(holder):
    properties.add(holder, CellParameters, "Group")
    assert holder.Obstacles == "none"
    holder.Obstacles = TEXTS["obstacles"]
    parameters = properties.read(holder, CellParameters, "cell")
    properties.write(holder, parameters)
    assert holder.Obstacles == TEXTS["obstacles"]  # unchanged values leave an older document alone
    properties.write(holder, dataclasses.replace(parameters, obstacles=parameters.obstacles[:0]))
    properties.write(holder, parameters)
    assert holder.Obstacles.startswith('[{"name": "post"')
    assert properties.read(holder, CellParameters, "cell") == parameters
    holder.Obstacles = "table.step"
    with pytest.raises(InputError, match="is not an obstacle") as error:
        properties.read(holder, CellParameters, "cell")
    assert error.value.where == "Héros n° 1.Obstacles"


@dataclasses.dataclass(frozen=True)
class _Welds(CurvesParameters):
    """Parameters of a family that extends another one."""

    overfill: float = f.parameter(0.5, f.LENGTH, "More than needed.", low=0.0)


def test_a_feature_reads_parameters_of_a_subclass_as_such(doc):
    class WeldsFeature(CurvesFeature):
        sections = (Section(_Welds, "strategy", "Layers"), *CurvesFeature.sections[1:])

    obj = doc.addObject("App::FeaturePython", "Welds")
    proxy = WeldsFeature(obj)
    assert proxy.parameters(obj, CurvesParameters) == _Welds()
    assert proxy.parameters(obj, BuildDirectionParameters) == BuildDirectionParameters()
