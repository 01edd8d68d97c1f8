# SPDX-License-Identifier: LGPL-2.1-or-later
"""Quantities have the same meaning as in FreeCAD."""

import math
import random

import FreeCAD
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters import field as f
from freecad_am.objects.fields import quantities

KINDS = {f.LENGTH: "Length", f.ANGLE: "Angle", f.SPEED: "Velocity", f.TIME: "TimeSpan"}


def outer(kind, value):
    return value / f.TO_INNER.get(kind, 1.0)


def texts(seed, count):
    """Yield random quantities of every form that a user may write, valid and invalid."""
    random_ = random.Random(seed)
    units = [unit for unit in quantities.UNITS if unit not in ("\u03bcm", "ms")] + [
        "foo",
        "mi",
        "Hz",
        "kg",
        "V",
        "",
    ]
    for _ in range(count):
        number = random_.choice(
            [
                f"{random_.uniform(0, 1000):.{random_.randint(0, 6)}f}",
                f"{random_.randint(0, 99)}",
                f".{random_.randint(0, 99)}",
                f"{random_.uniform(0, 9):.2e}",
                f"-{random_.uniform(0, 9):.3f}",
            ]
        )
        unit = random_.choice(units)
        if random_.random() < 0.4:
            unit += random_.choice(["/", " / "]) + random_.choice(units)
        form = random_.choice(
            ["{n} {u}", "{n}{u}", " {n}  {u} ", "{n}/2 {u}", "({n}+1) {u}", "2*{n} {u}"]
        )
        yield form.format(n=number, u=unit)


@pytest.mark.parametrize("kind", KINDS)
def test_means_what_freecad_means(kind):
    agreed = 0
    for text in texts(7, 1500):
        try:
            theirs = FreeCAD.Units.Quantity(text)
        except ValueError:
            theirs = None
        plain = theirs is not None and theirs.Unit == FreeCAD.Units.Unit()
        fits = theirs is not None and (plain or theirs.Unit == getattr(FreeCAD.Units, KINDS[kind]))
        if fits and math.isfinite(theirs.Value):
            assert outer(kind, quantities.read(text, kind, "key")) == pytest.approx(
                theirs.Value, rel=1e-14, abs=1e-300
            ), text
            agreed += 1
        else:
            with pytest.raises(InputError):
                quantities.read(text, kind, "key")
    assert agreed > 100


@pytest.mark.parametrize(
    ("value", "kind", "inner"),
    [
        ("1 mm", f.LENGTH, 1.0),
        ("0.5 in", f.LENGTH, 12.7),
        ("10 \u00b5m", f.LENGTH, 0.01),
        ("10 \u03bcm", f.LENGTH, 0.01),
        ("+3 mm", f.LENGTH, 3.0),
        (2, f.LENGTH, 2.0),
        ("2", f.LENGTH, 2.0),
        ("1e-3", f.LENGTH, 1e-3),
        ("90 deg", f.ANGLE, math.pi / 2),
        (180, f.ANGLE, math.pi),
        ("1 rad", f.ANGLE, 1.0),
        ("90\u00b0", f.ANGLE, math.pi / 2),
        ("360 mm/min", f.SPEED, 6.0),
        ("6 mm/s", f.SPEED, 6.0),
        (6.5, f.SPEED, 6.5),
        ("1 m/min", f.SPEED, 1000 / 60),
        ("50 ms", f.TIME, 0.05),
        ("1.5e2ms", f.TIME, 0.15),
        ("6 mm/ms", f.SPEED, 6000.0),
        ("2 s", f.TIME, 2.0),
        ("1 min", f.TIME, 60.0),
        ("20 %", f.RATIO, 0.2),
        (20, f.RATIO, 0.2),
        ("0.2", f.NUMBER, 0.2),
        ("180 deg/mm", f.TURN_RATE, math.pi),
        (90, f.TURN_RATE, math.pi / 2),
        ("1 rad/cm", f.TURN_RATE, 0.1),
        ("inf", f.LENGTH, math.inf),
        ("-inf", f.LENGTH, -math.inf),
        ("1/2 in", f.LENGTH, 12.7),
    ],
)
def test_reads(value, kind, inner):
    assert quantities.read(value, kind, "key") == pytest.approx(inner, rel=1e-15)


@pytest.mark.parametrize(
    ("value", "kind", "code", "says"),
    [
        ("1,5 mm", f.LENGTH, "BAD_VALUE", "1.5 mm"),
        ("90 deg", f.LENGTH, "BAD_UNIT", "angle"),
        ("1 mm", f.SPEED, "BAD_UNIT", "6 mm/s"),
        ("1 mm/s", f.LENGTH, "BAD_UNIT", "speed"),
        ("1 parsec", f.LENGTH, "BAD_UNIT", "1 parsec"),
        ("", f.LENGTH, "BAD_VALUE", "1 mm"),
        (True, f.LENGTH, "BAD_VALUE", "true"),
        (None, f.LENGTH, "BAD_VALUE", "null"),
        ([1], f.LENGTH, "BAD_VALUE", "[1]"),
        ("nan", f.LENGTH, "BAD_UNIT", "nan"),
        (math.nan, f.LENGTH, "BAD_VALUE", "nan"),
        ("20 %", f.LENGTH, "BAD_UNIT", "percent"),
        ("1 mm^2", f.LENGTH, "BAD_UNIT", "dimension"),
        ("1e999 mm", f.LENGTH, "BAD_VALUE", "large"),
        ("1 \u00a7mm", f.LENGTH, "BAD_UNIT", "known unit"),
        ("5 mm", f.NUMBER, "BAD_UNIT", "without a unit"),
        ("1 MM", f.LENGTH, "BAD_UNIT", "1 MM"),
        ("x" * 500, f.LENGTH, "BAD_UNIT", "..."),
    ],
)
def test_refuses(value, kind, code, says):
    with pytest.raises(InputError) as caught:
        quantities.read(value, kind, "strategy.key")
    assert caught.value.code == code
    assert caught.value.where == "strategy.key"
    assert says in caught.value.message
    assert len(caught.value.message) < 250
