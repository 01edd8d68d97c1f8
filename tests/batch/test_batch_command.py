# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `batch` plans a table of jobs."""

import csv
import io
import json
from types import SimpleNamespace

import FreeCAD
import pytest

from freecad_am.batch import rows

SPHERE = "part.set.Ball.Radius"


def summary(command):
    return list(csv.DictReader(io.StringIO(command.out)))


@pytest.mark.parametrize("processes", [pytest.param(1, marks=pytest.mark.long), 3])
def test_one_plan_per_row(workshop, processes):
    (workshop.folder / "rows.csv").write_text(
        "strategy.layer_height,cell.branch,process.travel_speed\n"
        '4 mm,"[front, up, flip]",6 mm/s\n8,,360 mm/min\n10 mm,auto,\n',
        encoding="utf-8",
    )
    command = workshop.launch(
        "batch", "rows.csv", "--job", "cup.yaml", "-o", "all", "-j", processes
    )
    assert command.status == 0, command.err
    rows = summary(command)
    assert [row["row"] for row in rows] == ["1", "2", "3"]
    assert [row["layers"] for row in rows] == ["16", "8", "7"]
    assert [row["strategy.layer_height"] for row in rows] == ["4 mm", "8", "10 mm"]
    assert all(row["exit"] == "0" and row["status"] == "ok" for row in rows)
    for row in rows:
        report = json.loads((workshop.folder / "all" / row["folder"] / "report.json").read_text())
        assert report["counts"]["layers"] == int(row["layers"])
        assert (workshop.folder / "all" / row["folder"] / "program" / "CUP.LS").is_file()


def test_a_row_is_what_plan_makes_of_it(workshop):
    (workshop.folder / "rows.csv").write_text("strategy.layer_height\n6 mm\n")
    assert workshop.launch("batch", "rows.csv", "--job", "cup.yaml", "-o", "rows").status == 0
    workshop.change("layer_height: 4 mm", "layer_height: 6 mm")
    assert workshop.launch("plan", "cup.yaml", "-o", "plan").status == 0
    row, plan = workshop.files("rows/row-001"), workshop.files("plan")
    assert set(row) == set(plan)
    assert all(
        row[name] == plan[name]
        for name in row
        if name.startswith("program/") or name == "waypoints.csv"
    )


@pytest.mark.parametrize(
    ("ends", "statuses", "worst"),
    [
        (["8 mm,0", "10 mm,9000"], ["0", "3"], 3),
        (["1 kg,0", "10 mm,9000", "8 mm,0"], ["2", "3", "0"], 2),
    ],
)
@pytest.mark.always("ends1-statuses1-2")
def test_ends_with_the_worst_row(workshop, ends, statuses, worst):
    workshop.change(
        "limits: paper", "limits: paper\n  deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0]"
    )
    table = ["strategy.layer_height,cell.deposition_point"]
    for row in ends:
        height, shift = row.split(",")
        table.append(f'{height},"[{1045.747 + float(shift)}, -630.155, 653.167, 0, 0, 0]"')
    (workshop.folder / "rows.csv").write_text("\n".join(table))
    command = workshop.run("batch", "rows.csv", "--job", "cup.yaml", "-j", "2")
    assert command.status == worst
    row_statuses = summary(command)
    assert [row["exit"] for row in row_statuses] == statuses
    assert all(row["message"] for row in row_statuses if row["exit"] != "0")
    assert all("row" in line for line in command.err.splitlines())


@pytest.mark.parametrize(
    ("ends", "worst"),
    [
        ((130, 0), 130),
        ((130, 130), 130),
        ((3, 130), 130),
        ((2, 130), 130),
        ((130, 1), 1),
        ((0, 3), 3),
        ((0, 0), 0),
    ],
)
def test_rows_that_were_interrupted_count(workshop, monkeypatch, ends, worst):
    """Rows whose process was told to end count as interrupted; such a batch once returned 0, or an
    internal error."""
    (workshop.folder / "rows.csv").write_text("process.travel_speed\n5 mm/s\n6 mm/s\n")
    monkeypatch.setattr(
        rows,
        "_planned",
        lambda waiting, *_: (
            (row, {"exit": end, "message": ""}) for row, end in zip(waiting, ends, strict=True)
        ),
    )
    messages = []
    session = SimpleNamespace(
        outcome="", say=messages.append, progress=messages.append, out=messages.append
    )
    assert (
        rows.run(
            str(workshop.folder / "rows.csv"),
            str(workshop.job),
            None,
            rows.How(processes=2),
            session,
        )
        == worst
    )
    assert [line.split(",")[0] for line in messages[-1].splitlines()[1:]] == ["1", "2"]


def test_sets_properties_of_a_document(workshop):
    document = FreeCAD.newDocument("Model")
    ball = document.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1 = 30, 0
    document.recompute()
    document.saveAs(str(workshop.folder / "model.FCStd"))
    FreeCAD.closeDocument(document.Name)
    original = (workshop.folder / "model.FCStd").read_bytes()
    workshop.change("part: {file: cup.step}", "part: {file: model.FCStd, object: Ball}")
    (workshop.folder / "rows.csv").write_text(f"name,{SPHERE}\nsmall,20 mm\nlarge,4 cm\nasis,\n")
    command = workshop.run("batch", "rows.csv", "--job", "cup.yaml", "-o", "out", "-j", "2")
    assert command.status == 0, command.err
    rows = summary(command)
    assert [row["folder"] for row in rows] == ["small", "large", "asis"]
    assert [int(row["layers"]) for row in rows] == [8, 16, 12]
    assert (workshop.folder / "model.FCStd").read_bytes() == original
    for column, cell, says in (
        ("part.set.Bowl.Radius", "20 mm", "Bowl"),
        ("part.set.Ball.Size", "20 mm", "no property 'Size'"),
        (SPHERE, "20 s", "does not fit"),
        (SPHERE, "-5 mm", "Ball"),
        ("part.set.Ball", "1", "object"),
    ):
        (workshop.folder / "bad.csv").write_text(f"{column}\n{cell}\n")
        command = workshop.run("batch", "bad.csv", "--job", "cup.yaml")
        assert command.status == 2, (column, command.err)
        assert says in command.err and "error[" in command.err


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("", "no rows"),
        ("strategy.layer_height\n", "no rows"),
        ("strategy.hight\n1\n", "layer_height"),
        ("tragedy.layer_height\n1\n", "tragedy"),
        ("name,name\na,b\n", "duplicated"),
        ("name,\na,b\n", "empty"),
        ("strategy.layer_height\n1,5 mm\n", "2 cells for 1"),
        ("strategy.layer_height;name\n1 mm;a\n", "commas"),
        ('strategy.layer_height\n"1,5 mm"\n', "point"),
        ('name\n"a\n', "table"),
        ("name\na\nb,c\n", "row 2"),
        ("strategy.layer_height\n[1\n", "not understood"),
        ("part.set.Ball.Radius\n1 mm\n", "FCStd"),
    ],
)
def test_tables_that_are_wrong(workshop, table, says):
    (workshop.folder / "rows.csv").write_text(table, encoding="utf-8")
    command = workshop.run("batch", "rows.csv", "--job", "cup.yaml")
    assert command.status == 2
    assert says in command.err and command.err.startswith("error[")
    assert "Traceback" not in command.err


def test_a_table_that_is_not_text(workshop):
    (workshop.folder / "rows.csv").write_bytes(b"\xff\xfe\x00")
    assert workshop.run("batch", "rows.csv", "--job", "cup.yaml").status == 2
    assert workshop.run("batch", "none.csv", "--job", "cup.yaml").status == 2
    (workshop.folder / "rows.csv").write_text("name\na\n")
    assert workshop.run("batch", "rows.csv", "--job", "none.yaml").status == 2
