# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results come back from floats and text bit for bit."""

import json
import zlib

import numpy as np
import pytest

from freecad_am.core.issues import InputError, Issue
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.objects.results import store


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


def equal(one, other):
    if isinstance(one, np.ndarray):
        return (
            one.dtype == other.dtype
            and one.shape == other.shape
            and one.tobytes() == other.tobytes()
        )
    if isinstance(one, tuple):
        return isinstance(other, tuple) and len(one) == len(other) and all(map(equal, one, other))
    if hasattr(one, "__dataclass_fields__"):
        names = one.__dataclass_fields__
        return type(one) is type(other) and all(
            equal(getattr(one, n), getattr(other, n)) for n in names
        )
    return type(one) is type(other) and one == other


@pytest.mark.parametrize("seed", range(5))
def test_toolpaths_come_back(seed):
    path = toolpath(seed)
    floats, text = store.pack(path, "k")
    assert all(type(number) is float for number in floats)
    assert equal(store.unpack(floats, text, "k", "x"), path)


@pytest.mark.parametrize("seed", range(5))
def test_parts_alone_are_those_of_the_whole(seed):
    path = toolpath(seed)
    places = (
        ("layers", -1, "beads", -1, "points"),
        ("layer_height",),
        (),
        ("layers", 0, "beads"),
        ("frame",),
    )
    parts = store.picked(*store.pack(path, "k"), "k", "x", *places)
    assert equal(
        parts, (path.layers[-1].beads[-1].points, 1.0, path, path.layers[0].beads, path.frame)
    )
    alone = store.picked(
        *store.pack(path, "k"), "k", "x", *places[:2], *places[3:]
    )  # where nothing asks for the whole
    assert equal(alone, (*parts[:2], *parts[3:]))
    for wrong in (("height",), ("layers", 9), ("layer_height", 0)):
        with pytest.raises(InputError, match="cannot be read"):
            store.picked(*store.pack(path, "k"), "k", "x", wrong)


@pytest.mark.parametrize("length", [0, 1, 5, 6, 7, 1000, 100_003])
def test_bytes_come_back(length):
    data = np.random.default_rng(length).integers(0, 256, length, dtype=np.uint8).tobytes()
    files = {"A.LS": data, "é.LS": b""}
    assert store.unpack(*store.pack(files, "k"), "k", "x") == files
    older = np.zeros(-(-len(zlib.compress(data)) // 6) * 8, dtype=np.uint8).reshape(-1, 8)
    older[:, :6].flat[: len(zlib.compress(data))] = np.frombuffer(
        zlib.compress(data), dtype=np.uint8
    )
    floats = [store.pack((), "k")[0][0], *older.view("<u8").ravel().astype(float)]
    assert store.unpack(floats, f'k {{"b":[{len(zlib.compress(data))},1]}}', "k", "x") == data


def test_files_alike_take_the_room_of_one():
    random = np.random.default_rng(1)
    text = random.integers(0, 256, 100_000, dtype=np.uint8).tobytes()
    files = {f"P{k}.LS": text[:k] + b"x" + text[k:] for k in range(0, 100_000, 10_000)}
    floats, _ = store.pack(files, "k")
    assert len(floats) < 1.1 * len(text) / 7
    assert store.unpack(*store.pack(files, "k"), "k", "x") == files


def test_arrays_of_alike_values_are_one_table_in_memory():
    path = toolpath(3)
    back = store.unpack(
        *store.pack({"all": tuple((layer.beads,) for layer in path.layers)}, "k"), "k", "x"
    )
    values = tuple(np.random.default_rng(k).normal(size=(k + 2, 3)) for k in range(9))
    tables = store.unpack(*store.pack(values, "k"), "k", "x")
    assert len({id(part.base) for part in tables}) == 1 and all(map(equal, tables, values))
    assert not any(part.flags.writeable or part.base.flags.writeable for part in tables)
    assert all(
        equal(one, layer.beads) for (one,), layer in zip(back["all"], path.layers, strict=True)
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


def test_a_document_cannot_name_what_is_called():
    floats, _ = store.pack((), "k")
    ours = (
        ".api:open_part",
        ".core.issues:InputError",
        ".batch.host:find_freecad",
        ".objects.store:pack",
    )
    for name in ("os:system", *ours):
        with pytest.raises(InputError, match="recompute"):
            store.unpack(floats, "k " + json.dumps({"c": name, "v": {}}), "k", "x")


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


def test_a_table_that_says_it_is_huge_is_damaged_and_takes_no_memory():
    floats, text = store.pack(toolpath(), "k")
    layout = json.loads(text[2:])
    layout["t"][0][1] = 10**12
    path = toolpath()
    huge = f"k {json.dumps(layout)}".replace(
        f'"a": [0, 0, {len(path.layers[0].beads[0])}]', '"a": [0, 0, 1000000000000]'
    )
    assert huge.count("1000000000000") == 2
    for places in ((), (("layers", 0, "beads", 0, "points"),)):
        with pytest.raises(InputError, match="cut short"):
            store.picked(floats, huge, "k", "x", *places, ())


def test_parts_of_two_results_do_not_pass_for_one():
    (one, one_text), (other, other_text) = (
        store.pack((1.0,), "a" * 32),
        store.pack((2.0,), "b" * 32),
    )
    assert store.unpack(one, one_text, "a" * 32, "x") == (1.0,)
    for mixed in (
        (other, one_text, "a" * 32),
        (one, other_text, "a" * 32),
        (one, one_text, "b" * 32),
    ):
        with pytest.raises(InputError, match="other inputs"):
            store.unpack(*mixed, "x")


def test_what_is_no_data_is_refused():
    with pytest.raises(TypeError):
        store.pack(object(), "k")
    for array in (
        np.array(1.0),
        np.zeros(3, dtype=np.float32),
        np.array([2**53 + 1]),
        np.array([-(2**60), 0]),
    ):
        with pytest.raises(TypeError, match="cannot be stored"):
            store.pack((array,), "k")
    whole = np.array([2**53, -(2**53)])
    assert equal(store.unpack(*store.pack((whole, whole[:0]), "k"), "k", "x"), (whole, whole[:0]))
