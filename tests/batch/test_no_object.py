# SPDX-License-Identifier: LGPL-2.1-or-later
"""If a document does not identify a single object, the message states the case."""

import FreeCAD as App
import pytest

JOB = """version: 1
name: part
part: {{file: model.FCStd{more}}}
strategy: {{kind: solid, layer_height: 5 mm}}
"""


@pytest.mark.parametrize(
    ("boxes", "more", "message"),
    [
        ([], "", "no object in the document has a shape; recompute and save the document"),
        (["Left", "Right"], "", "2 objects have a shape of their own (Left, Right)"),
        (
            ["Left"],
            ", object: Middle",
            "no object with a shape is called 'Middle'; use one of Left",
        ),
        (
            ["Left", "Left"],
            ", object: Left",
            "2 objects have the label 'Left'; change the label of one object",
        ),
        (["Left"], ", object: Left, set: {Right: {Length: 4}}", "no object is called 'Right'"),
        (
            ["Left", "Left"],
            ", object: Box, set: {Left: {Length: 4}}",
            "'Left' is the label of several objects (Box, Box001)",
        ),
    ],
)
def test_no_single_object(workshop, boxes, more, message):
    document = App.newDocument("Model")
    preference = App.ParamGet("User parameter:BaseApp/Preferences/Document")
    original_setting = preference.GetBool("DuplicateLabels")
    preference.SetBool("DuplicateLabels", True)
    try:
        for label in boxes:
            document.addObject("Part::Box", "Box").Label = label
        document.recompute()
        document.saveAs(str(workshop.folder / "model.FCStd"))
    finally:
        preference.SetBool("DuplicateLabels", original_setting)
        App.closeDocument(document.Name)
    (workshop.folder / "part.yaml").write_text(JOB.format(more=more), encoding="utf-8")
    command = workshop.run("plan", "part.yaml")
    assert command.status == 2 and "error[NO_OBJECT]" in command.err
    assert message in command.err
