# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages keep their template and values on the whole way from the code that raises them to the
window."""

import ast
import copy
import dataclasses
import json
import pickle
import random
import traceback
from pathlib import Path
from types import SimpleNamespace

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.batch import run
from freecad_am.batch.job import job as jobs
from freecad_am.batch.row import Order, row_result, start_row
from freecad_am.brep.files import read
from freecad_am.core.issues import AmError, InputError, Issue, Text, Word
from freecad_am.core.kinematics.machines import machine
from freecad_am.gui.in_language import in_language
from freecad_am.objects.fields import rows
from freecad_am.objects.results.findings import issues_of, message_of
from freecad_am.objects.staleness import INFEASIBLE
from tests.robust import job_bases, mutations
from tests.told_in_french import check_french, table

ROOT = Path(__file__).resolve().parent.parent
NO_BREAK = "\u00a0"


@pytest.fixture(scope="module")
def french():
    return table()


# ---- texts


def test_a_text_is_the_sentence():
    name, width, count = "Ab", 2.34567, 12
    text = Text("{} is {:.3g} mm wide, {!r}: {{}} of {:,}", name, width, name, 1000 * count)
    assert text == f"{name} is {width:.3g} mm wide, {name!r}: {{}} of {1000 * count:,}"
    assert text.template == "{0} is {1} mm wide, {2}: {{}} of {3}" and text.values == (
        "Ab",
        "2.35",
        "'Ab'",
        "12,000",
    )
    assert text.template.format(*text.values) == text and json.dumps([text]) == json.dumps(
        [str(text)]
    )
    assert Text("{1} before {0}", "b", "a") == "a before b" and Text("a {brace}") == "a {brace}"
    assert Text("{} {}", "x", Word("rows")).template == "{0} rows"
    nested_text = Text("it is {}{}", 3, Word(Text("; {} of {}", 1, 2)))
    assert (nested_text, nested_text.template, nested_text.values) == (
        "it is 3; 1 of 2",
        "it is {0}; {1} of {2}",
        ("3", "1", "2"),
    )


@pytest.mark.parametrize(
    "way", [copy.deepcopy, copy.copy, lambda text: pickle.loads(pickle.dumps(text))]
)
def test_a_text_keeps_its_parts(way):
    inner = Text("use {:g} mm", 2)
    for text in (
        Text("{}: {}; {{}}", "Box", inner),
        inner + "; " + inner,
        "a " + inner,
        Text("as {it} is"),
    ):
        again = way(text)
        assert (again, again.template, again.values) == (text, text.template, text.values)
    assert dataclasses.asdict(Issue("note", "X", inner))["message"].template == "use {0} mm"


def test_texts_in_a_row_keep_their_parts():
    texts = [Text("{} mm", k) for k in range(5)]
    joined = Text.joined(" and ", texts)
    assert joined == " and ".join(texts) and joined.template == "{0} and {1}"
    assert Text.joined(", ", ["a"]) == "a" and Text.joined(", ", ()) == ""
    long_text = Text.joined("; ", map(str, range(5000)))
    assert in_language(long_text, {"{0}; {1}": "{0} ; {1}"}.get) == " ; ".join(
        map(str, range(5000))
    )


def test_errors_carry_theirs():
    error = InputError(
        "X", "Box", "it has {} faces; {}", 3, Text("use {}", "one"), mended_by={"a": 1}
    )
    assert (
        str(error) == "Box: it has 3 faces; use one"
        and error.line() == "error[X] Box: it has 3 faces; use one"
    )
    assert error.message.template == "it has {0} faces; {1}" and error.sentence.values == (
        "Box",
        error.message,
    )
    assert InputError("X", "Box", "give {a: 1}").message == "give {a: 1}" and error.mended_by == {
        "a": 1
    }


# ---- messages keep their values

ERRORS, TELLING = ("AmError", "InputError", "InfeasibleError"), {"Issue": 2}


def loses_values(node: ast.AST | None) -> bool:
    """Return whether an expression formats a text without keeping its values."""
    if isinstance(node, ast.IfExp):
        return loses_values(node.body) or loses_values(node.orelse)
    if isinstance(node, ast.BoolOp):
        return any(map(loses_values, node.values))
    if isinstance(node, ast.JoinedStr):
        return any(isinstance(operand, ast.FormattedValue) for operand in node.values)
    if isinstance(node, ast.BinOp):
        operands = (node.left, node.right)
        return isinstance(node.op, (ast.Add, ast.Mod)) and any(
            isinstance(operand, ast.JoinedStr) or isinstance(getattr(operand, "value", None), str)
            for operand in operands
        )
    if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
        return False
    is_translated = (
        getattr(getattr(node.func.value, "func", None), "id", "") == "tr"
    )  # the window's translations are already in its language
    return node.func.attr in ("format", "join") and not is_translated


def find_lost_values(tree: ast.AST) -> list[int]:
    """Return the lines with an error or issue whose message loses its values, directly or through a
    variable."""
    messages, waiting = [], [(tree, {})]
    for (
        node,
        assignments,
        # the list grows while it is read; `assignments` are the values of a function's variables
    ) in waiting:
        if isinstance(node, (ast.Assign, ast.AnnAssign, ast.AugAssign)):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                assignments.setdefault(getattr(target, "id", ""), []).append(node.value)
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            position = 2 if name in ERRORS else TELLING.get(name)
            if position is not None and len(node.args) > position:
                messages.append((node, node.args[position], assignments))
        inner = {} if isinstance(node, ast.FunctionDef) else assignments
        waiting += [(child, inner) for child in ast.iter_child_nodes(node)]
    return [
        call.lineno
        for call, text, assignments in messages
        if any(
            map(
                loses_values,
                [text, *(assignments.get(text.id, []) if isinstance(text, ast.Name) else [])],
            )
        )
    ]


def test_no_message_forgets_what_it_is_made_of():
    texts = {
        path: path.read_text(encoding="utf-8")
        for path in sorted((ROOT / "freecad_am").rglob("*.py"))
    }
    telling = {
        path: text
        for path, text in texts.items()
        if any(f"{name}(" in text for name in (*ERRORS, *TELLING))
    }
    lost_values = {
        path.relative_to(ROOT).as_posix(): find_lost_values(ast.parse(text))
        for path, text in telling.items()
    }
    assert len(telling) > 200
    wrong = {name: lines for name, lines in lost_values.items() if lines}
    assert wrong == {}, (
        "give the message as a template with its values: InputError(code, where, 'it has {} faces', count)"
    )


def test_a_message_that_forgets_is_found():
    for text in (
        'InputError("A", b, f"it {c}")',
        'Issue(d, "A", "it " + c)',
        'InputError("A", b, "x" if y else f"{c}")',
        'InfeasibleError("A", b, "{} a".format(c))',
        'Issue(d, "A", "; ".join(c))',
    ):
        assert find_lost_values(ast.parse(text)) == [1], text
    assert find_lost_values(
        ast.parse('def a():\n    why = f"{b} c"\n    raise InputError("A", b, why)')
    ) == [3]
    assert (
        find_lost_values(
            ast.parse(
                'InputError("A", f"{b}", "it has {}", f"{c:.3g}")\nIssue(d, "A", Text("{} it", c))'
            )
        )
        == []
    )


# ---- errors in French


def error_message(work, *arguments):
    """Return the message of the error that some work raises. Return None without an error and for
    errors of the command line, which are in English only."""
    try:
        work(*arguments)
    except AmError as error:
        while isinstance(error.__context__, AmError):
            error = error.__context__
        return (
            None
            if "/batch/" in traceback.extract_tb(error.__traceback__)[-1].filename
            else error.message
        )
    return None


def test_errors_of_parameters_are_told_in_french(french):
    """Errors about parameters are in French, for odd values of all parameters as a panel or a macro
    sets them."""
    sections = {
        *mutations.SECTIONS.values(),
        *mutations.RARE_SECTIONS.values(),
        *mutations.STRATEGIES.values(),
    }
    entered = [
        (cls, row, odd)
        for cls in sorted(sections, key=lambda cls: cls.__name__)
        for row in rows.rows(cls)
        for odd in mutations.ODD
        if isinstance(odd, str)
    ]
    messages = set()
    for cls, row, odd in random.Random(16).sample(entered, 4000):
        message = error_message(lambda: rows.build(cls, {row.key: row.inner(odd, row.label)}))  # noqa: B023
        if message is not None:
            check_french(message, french)
            messages.add(getattr(message, "template", message))
    assert len(messages) > 20, messages


def test_errors_of_damaged_machine_files_are_told_in_french(tmp_path, french):
    sound = json.loads(
        (ROOT / "freecad_am" / "machines" / "fanuc-arcmate120ic.json").read_text(encoding="utf-8")
    )
    messages = set()
    for damaged in list(damages(sound))[::7]:
        (tmp_path / "damaged.json").write_text(json.dumps(damaged), encoding="utf-8")
        message = error_message(machine.load, tmp_path / "damaged.json")
        if message is not None:
            check_french(message, french)
            messages.add(getattr(message, "template", message))
    assert len(messages) > 10, messages


def damages(value):
    """Yield a tree with each entry removed, and with each entry replaced by an odd value."""
    entries = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, entry in entries:
        for put in ("left out", None, -1.5, "word", [[]], {"other": 1}):
            changed = copy.copy(value)
            if put == "left out":
                del changed[key]
            else:
                changed[key] = put
            yield changed
        for inner in damages(entry):
            changed = copy.copy(value)
            changed[key] = inner
            yield changed


# invalid values in a cell's file, by key
INVALID_CELL_VALUES = {
    "machine": (
        "{file: a.urdf, top: x}",
        "{file: 3}",
        "{base: x}",
        "{name: ur-ur10e}",
        "{file: a.step}",
    ),
    "platform": (
        "3 kg",
        "20 %",
        "1,5 mm",
        ".nan mm",
        "5 parsecs",
        "''",
        "[1, 2]",
        "[0, 0, 0, 0, 0]",
        "1e12 mm",
    ),
    "setup": ("part_on_robot", "7", "[]", "!x a", "{}"),
    "deposition_point": ("far", "[1, 2, 3]", "[1, 2, 3, 4, 5, '6 mm/s']", "12 mm"),
    "external": (
        "here",
        "[{}]",
        "[{machine: a, pose: 3}]",
        "[{machine: 7, pose: [0, 0, 0, 0, 0, 0]}]",
    ),
    "obstacles": ("here", "[{file: nowhere.step}]", "[{box: 3}]", "[{box: [1, 2, true]}]", "[3]"),
    "nozzle": ("{shape: nowhere.step}", "{length: {}}", "{shape: {file: nowhere.step}}", "yes"),
    "touched": ("3", "[{part: [0, 0], robot: 3}]"),
    "world_up": ("[0, x, 1]", "[0, 0, '1 deg']"),
    "kind": ("1",),
    "limits": ("7", "&a [*a]"),
    "{a: 1}": ("1",),
}


def test_errors_of_files_of_cells_are_told_in_french(tmp_path, french):
    """Errors in a cell's file are in French, because the window shows them when a saved cell is
    chosen."""
    texts = [
        f"machine: ur-ur10e\n{key}: {value}\n"
        for key, values in INVALID_CELL_VALUES.items()
        for value in values
    ]
    texts += [
        "",
        "- a\n",
        "a: 1\na: 2\n",
        "a: [",
        "machine: " + "[" * 40 + "]" * 40,
        "a: " + "[" * 9000,
    ]
    messages = set()
    for text in texts:
        (tmp_path / "my.yaml").write_text(text, encoding="utf-8")
        message = error_message(api.read_cell, str(tmp_path / "my.yaml"))
        assert message is not None, text
        check_french(message, french)
        messages.add(getattr(message, "template", message))
    for name, content in {
        "latin.yaml": "setup: é".encode("latin-1"),
        "nowhere.yaml": None,
        "folder": None,
    }.items():
        if content is not None:
            (tmp_path / name).write_bytes(content)
        messages.add(check_french(error_message(api.read_cell, str(tmp_path / name)), french))
    assert len(messages) > 30, messages


@pytest.mark.parametrize(
    "numbers",
    [(7, 19), pytest.param(tuple(range(20)), marks=pytest.mark.long)],
    ids=["few", "more"],
)
def test_findings_of_jobs_are_told_in_french(numbers, doc, tmp_path, french):
    """Issues of jobs are in French: mutated jobs are planned as far as they can be."""
    job_bases.write_parts(tmp_path)
    base_jobs, job = job_bases.bases(str(tmp_path)), tmp_path / "job.yaml"
    session = SimpleNamespace(say=list, issues=list, progress=str, check=bool)
    count = 0
    for number in numbers:
        chance = random.Random(1600 + number)
        job.write_bytes(
            mutations.mutated(base_jobs[number * 61 % len(base_jobs)][1], chance, tmp_path)
        )
        stages = []
        message = error_message(
            lambda: stages.append(run.plan(jobs.read_job(str(job)), doc, session))  # noqa: B023
        )
        for text in [
            *([] if message is None else [message]),
            *(issue.message for stage in stages for issue in stage.issues),
        ]:
            check_french(text, french)
            count += 1
    assert count


# ---- messages between processes


def test_a_message_of_another_process_keeps_its_parts(tmp_path, french):
    file = tmp_path / "part.3mf"
    file.write_bytes(b"PK not a zip")
    with pytest.raises(InputError) as caught:
        read.read_mesh(str(file))
    assert check_french(caught.value.message, french) != caught.value.message
    assert (
        isinstance(caught.value.message.values[0], Text) and caught.value.message.values[0].values
    )


def test_a_message_of_a_row_of_a_batch_keeps_its_parts(tmp_path, french):
    values = {"version": 1, "part": {"file": "part.step"}, "strategy": {"layer_height": "-2 mm"}}
    order = Order("row 1", values, str(tmp_path / "job.yaml"), str(tmp_path / "out"), False)
    row = start_row(order)
    while not row.poll(60.0):
        pass
    message = row_result(row)["message"]
    assert (
        check_french(message, french)
        == f"-2 mm est hors de la plage{NO_BREAK}; donnez plus de 0 mm"
    )
    assert message.values[0] == "-2 mm"


# ---- messages in documents


@pytest.fixture
def infeasible(doc):
    """Return an infeasible joint path with its cell and toolpath."""
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Angle1 = 0
    doc.recompute()
    cell = api.make_cell(doc, deposition_point="3000 0 0 0 0 0")
    feature = api.make_feature(doc, sphere, layer_height=3)
    return api.make_joint_path(doc, api.make_toolpath(doc, feature, cell), cell)


def test_messages_of_a_document_are_told_in_french_when_it_is_opened_again(
    infeasible, tmp_path, french
):
    assert infeasible.Status == INFEASIBLE
    saved = infeasible.Message, infeasible.Issues, check_french(message_of(infeasible), french)
    reopened = [check_french(issue.message, french) for issue in issues_of(infeasible)]
    assert reopened and saved[2] != saved[0]
    infeasible.Document.saveAs(str(tmp_path / "a.FCStd"))
    again = App.openDocument(str(tmp_path / "a.FCStd"))
    try:
        opened = again.getObject(infeasible.Name)
        assert (opened.Message, opened.Issues, check_french(message_of(opened), french)) == saved
        assert [check_french(issue.message, french) for issue in issues_of(opened)] == reopened
    finally:
        App.closeDocument(again.Name)


def test_a_document_of_before_is_told_as_it_was_written(infeasible):
    infeasible.Texts = ""
    message, issue = message_of(infeasible), issues_of(infeasible)[0]
    assert (
        message == infeasible.Message
        and not isinstance(message, Text)
        and not isinstance(issue.message, Text)
    )
    api.change(infeasible, min_condition=0.02)
    assert isinstance(message_of(infeasible), Text)
