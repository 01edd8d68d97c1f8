# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results come back from floats and text bit for bit."""

import dataclasses
import io
import json
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.issues import InputError, Issue
from freecad_am.core.toolpath import (
    Bead,
    BeadEnds,
    BeadRole,
    Checks,
    Layer,
    MotionRules,
    SequencedFeature,
    SpeedLaw,
    Toolpath,
)
from freecad_am.objects.results import schemas, store


def toolpath(seed=0):
    rng = np.random.default_rng(seed)

    def bead(n):
        unit = rng.normal(size=(2, n, 3))
        unit /= np.linalg.norm(unit, axis=2, keepdims=True)
        width = rng.random(n) if n % 2 else None
        rising = np.cumsum(rng.random(n) + 0.1)
        return Bead(rng.normal(size=(n, 3)), unit[0], unit[1], rising, rng.random(n), False, width)

    layers = tuple(Layer(tuple(bead(n) for n in rng.integers(2, 9, size=k))) for k in (1, 3, 2))
    return Toolpath(layers, np.eye(4), 1.0, 0.01, (Issue("warning", "X", 'é\n"', 1, None, 3),))


def equal(value, expected):
    if isinstance(value, np.ndarray):
        return (
            value.dtype == expected.dtype
            and value.shape == expected.shape
            and value.tobytes() == expected.tobytes()
        )
    if isinstance(value, tuple):
        return (
            isinstance(expected, tuple)
            and len(value) == len(expected)
            and all(map(equal, value, expected))
        )
    if hasattr(value, "__dataclass_fields__"):
        names = value.__dataclass_fields__
        return type(value) is type(expected) and all(
            equal(getattr(value, n), getattr(expected, n)) for n in names
        )
    return type(value) is type(expected) and value == expected


@pytest.mark.parametrize("seed", range(5))
def test_toolpaths_come_back(seed):
    path = toolpath(seed)
    floats, text = store.pack(path, "k")
    assert all(type(number) is float for number in floats)
    assert equal(store.unpack(floats, text, "k", "x"), path)


@pytest.mark.parametrize("seed", range(5))
def test_parts_alone_are_those_of_the_whole(seed):
    path = toolpath(seed)
    paths = (
        ("layers", -1, "beads", -1, "points"),
        ("layer_height",),
        (),
        ("layers", 0, "beads"),
        ("frame",),
    )
    unpacked = store.unpack_parts(*store.pack(path, "k"), "k", "x", *paths)
    assert equal(
        unpacked, (path.layers[-1].beads[-1].points, 1.0, path, path.layers[0].beads, path.frame)
    )
    alone = store.unpack_parts(
        *store.pack(path, "k"), "k", "x", *paths[:2], *paths[3:]
    )  # where no caller needs the complete result
    assert equal(alone, (*unpacked[:2], *unpacked[3:]))
    for wrong in (("height",), ("layers", 9), ("layer_height", 0)):
        with pytest.raises(InputError, match="cannot be read"):
            store.unpack_parts(*store.pack(path, "k"), "k", "x", wrong)


@pytest.mark.parametrize("length", [0, 1, 5, 6, 7, 1000, 100_003])
def test_bytes_come_back(length):
    data = np.random.default_rng(length).integers(0, 256, length, dtype=np.uint8).tobytes()
    files = {"A.LS": data, "é.LS": b""}
    assert store.unpack(*store.pack(files, "k"), "k", "x") == files


def test_arrays_of_alike_values_are_one_table_in_memory():
    path = toolpath(3)
    back = store.unpack(
        *store.pack({"all": tuple((layer.beads,) for layer in path.layers)}, "k"), "k", "x"
    )
    values = tuple(np.random.default_rng(k).normal(size=(k + 2, 3)) for k in range(9))
    tables = store.unpack(*store.pack(values, "k"), "k", "x")
    assert len({id(table.base) for table in tables}) == 1 and all(map(equal, tables, values))
    assert not any(table.flags.writeable or table.base.flags.writeable for table in tables)
    assert all(
        equal(bead, layer.beads) for (bead,), layer in zip(back["all"], path.layers, strict=True)
    )


def test_special_numbers_and_types_come_back():
    values = (
        np.array([np.nan, -0.0, np.inf, -np.inf, 5e-324, 0.1]),
        np.array([True, False]),
        np.array([2**53, -1]),
        np.zeros((0, 3)),
        np.arange(6.0).reshape(3, 2)[:, ::-1],
        np.zeros((4, 0)),
        np.arange(24).reshape(2, 3, 4),
        None,
        True,
        3,
        0.1,
        "ü",
        (),
        np.float64(2.5),
    )
    back = store.unpack(*store.pack(values, "k"), "k", "x")
    assert equal(back[:7], tuple(np.ascontiguousarray(v) for v in values[:7]))
    assert back[7:] == (None, True, 3, 0.1, "ü", (), 2.5)


def renamed(text, **changes):
    """Return the text of a result with other entries in its header."""
    return f"k {json.dumps({**json.loads(text[2:]), **changes})}"


def test_a_document_cannot_name_what_is_called():
    floats, text = store.pack((), "k")
    names = ("os:system", ".api:open_part", "core.issues:InputError", "batch.host:find_freecad", "")
    for name in names:
        tree = {"schema": name, "fields": {}}
        with pytest.raises(InputError, match="not a result that this version knows"):
            store.unpack(floats, renamed(text, value=tree, schemas={name: 1}), "k", "x")
        former = json.dumps({"c": name, "v": {}})
        with pytest.raises(InputError, match="is not a result"):
            store.unpack(floats, f"k {former}", "k", "x")


def test_no_module_is_named_in_a_document():
    _, text = store.pack(toolpath(), "k")
    assert "core" not in text and "Toolpath" not in text and '"schema":"toolpath"' in text


def test_every_schema_has_its_class():
    for name, schema in schemas.SCHEMAS.items():
        kind = schemas.class_of(name)
        assert dataclasses.is_dataclass(kind) and schemas.schema_of_class(kind) == (name, schema)


def test_a_class_that_is_renamed_and_changed_reads_what_was_stored_before(monkeypatch):
    """The entry moves to the new class, and the fields of version 1 become those of version 2."""
    floats, text = store.pack(toolpath().layers, "k")
    class_path = f"{__name__}:Stack"
    monkeypatch.setitem(schemas.SCHEMAS, "layer", schemas.Schema(class_path, 2))
    upgrades = {
        ("layer", 1): lambda fields: {"strands": fields["beads"], "count": len(fields["beads"])}
    }
    monkeypatch.setattr(schemas, "UPGRADES", upgrades)
    class_of = schemas.class_of
    monkeypatch.setattr(
        schemas, "class_of", lambda name: Stack if name == "layer" else class_of(name)
    )
    stacks = store.unpack(floats, text, "k", "x")
    assert [stack.count for stack in stacks] == [1, 3, 2]
    assert equal(stacks[0].strands, toolpath().layers[0].beads)


@dataclasses.dataclass(frozen=True)
class Stack:
    strands: tuple
    count: int


def test_a_result_of_a_later_version_is_rejected():
    floats, text = store.pack(toolpath(), "k")
    later = {**json.loads(text[2:])["schemas"], "layer": 9}
    for changes in ({"schemas": later}, {"format": 9}):
        with pytest.raises(InputError, match="later"):
            store.unpack(floats, renamed(text, **changes), "k", "x")


def test_the_archive_is_plain_npz():
    """numpy's own reader opens the archive."""
    path = toolpath()
    floats, text = store.pack(path, "k")
    words = np.array(floats[1:]).view(np.uint8).reshape(-1, 8)[:, :7]
    archive = np.load(io.BytesIO(words.tobytes()[: json.loads(text[2:])["bytes"]]))
    points = np.concatenate([bead.points for layer in path.layers for bead in layer.beads])
    assert any(
        table.shape == points.shape and (table == points).all() for table in archive.values()
    )


def former_values():
    """Return the values from which the results in data/format-4.npz were made."""
    rng = np.random.default_rng(5)
    smooth = np.cumsum(np.cumsum(rng.normal(size=20000))) * 1e-6
    numbers = np.concatenate([smooth[:5000], np.full(3000, 0.25), smooth[1000:9000], smooth])
    files = {f"P{k}.LS": bytes(rng.integers(0, 5, 2000, dtype=np.uint8)) for k in range(3)}
    return {
        "paths": tuple(toolpath(seed) for seed in range(3)),
        "numbers": numbers,
        "files": files,
        "whole": np.arange(5),
        "truth": np.array([True, False]),
        "text": "é",
        "none": None,
        "pair": (1, 2.5),
    }


def test_results_stored_before_format_5_are_read():
    """The results have runs, repetitions and differences; tests/objects/test_documents.py has a
    document of an earlier format."""
    stored = np.load(Path(__file__).parent / "data" / "format-4.npz")
    floats, text = stored["floats"], str(stored["text"])
    values, expected = store.unpack(floats, text, "k", "x"), former_values()
    assert values.keys() == expected.keys()
    assert all(equal(values[name], expected[name]) for name in expected if name != "files")
    assert values["files"] == expected["files"]
    with pytest.raises(InputError, match="cannot be read"):
        store.unpack(floats[:-9], text, "k", "x")
    with pytest.raises(InputError, match="cannot be read"):
        store.unpack(floats, text.replace('"n":[', '"n":[9'), "k", "x")


def sequenced_toolpath():
    """Return the value from which the result in data/toolpath-1.npz was made, when a toolpath was
    one flat record."""
    up = np.tile([0.0, 0.0, 1.0], (4, 1))

    def bead(z, **fields):
        points = np.array([[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 0.0, z]])
        return Bead(points, up, up, np.arange(4.0), np.full(4, 6.0), True, **fields)

    filled = bead(
        0.0,
        width=np.full(4, 5.0),
        height=np.full(4, 2.0),
        wire_share=1.5,
        role=BeadRole("closing", 2, True, True, "hull"),
        ends=BeadEnds(1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
        external=np.zeros((4, 2)),
        phase=np.arange(4.0),
    )
    checks = Checks(0.5, (10.0, 0.1, 0.2), (1.0, 2.0, 3.0), np.array([[0.0, 1.5, 2.5]]), 0.25)
    first_feature = Toolpath(
        (),
        np.eye(4),
        2.0,
        0.01,
        family="solid",
        law=SpeedLaw(1.0, 2.0, 3.0, 4.0),
        bead_width=5.0,
        wire_feed=7.0,
        rules=MotionRules(4.0, 6.0, 1.0),
        checks=checks,
    )
    second = Toolpath((), np.eye(4), 2.0, 0.02)
    return dataclasses.replace(
        first_feature.add_checks(unsupported=0.75),
        layers=(Layer((filled,)), Layer((bead(2.0),), 3.0, True, 1)),
        issues=(Issue("warning", "X", "text", 1),),
        features=(SequencedFeature("Pièce", first_feature), SequencedFeature("Tube", second)),
    )


def test_toolpaths_stored_as_one_flat_record_are_read():
    stored = np.load(Path(__file__).parent / "data" / "toolpath-1.npz")
    path = store.unpack(stored["floats"], str(stored["text"]), "k", "x")
    assert equal(path, sequenced_toolpath())
    assert equal(store.unpack(*store.pack(path, "k"), "k", "x"), path)


def test_damaged_results_are_told():
    floats, text = store.pack(toolpath(), "k")
    for bad in (
        (floats[:-1], text),
        (floats, text[:-1]),
        (floats, "k {}"),
        ([float("nan")] * len(floats), text),
    ):
        with pytest.raises(InputError) as caught:
            store.unpack(*bad, "k", "My path")
        assert caught.value.code == "BAD_RESULT" and caught.value.where == "My path"


def test_a_table_that_says_it_is_huge_is_damaged():
    floats, text = store.pack(toolpath(), "k")
    rows = len(toolpath().layers[0].beads[0])
    huge = text.replace(f'"array":[0,0,{rows}]', '"array":[0,0,1000000000000]')
    assert huge != text
    for paths in ((), (("layers", 0, "beads", 0, "points"),)):
        with pytest.raises(InputError, match="cut short"):
            store.unpack_parts(floats, huge, "k", "x", *paths, ())


def test_parts_of_two_results_do_not_pass_for_one():
    (first_data, one_text), (second_data, other_text) = (
        store.pack((1.0,), "a" * 32),
        store.pack((2.0,), "b" * 32),
    )
    assert store.unpack(first_data, one_text, "a" * 32, "x") == (1.0,)
    for mixed in (
        (second_data, one_text, "a" * 32),
        (first_data, other_text, "a" * 32),
        (first_data, one_text, "b" * 32),
    ):
        with pytest.raises(InputError, match="other inputs"):
            store.unpack(*mixed, "x")


def test_what_is_no_data_is_refused():
    with pytest.raises(TypeError):
        store.pack(object(), "k")
    for array in (
        np.array(1.0),
        np.zeros(3, dtype=np.float32),
    ):
        with pytest.raises(TypeError, match="cannot be stored"):
            store.pack((array,), "k")
    integers = np.array([2**53 + 1, -(2**60)])
    assert equal(
        store.unpack(*store.pack((integers, integers[:0]), "k"), "k", "x"), (integers, integers[:0])
    )
