# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mutate a valid job at random from a seed: its text, its structure and its values."""

import copy
import dataclasses
import json
import math

import yaml

from freecad_am.core.families import registry as families
from freecad_am.core.parameters import bead_classes
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.place import PlaceParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.scan import ScanParameters

SECTIONS = {
    "build_direction": BuildDirectionParameters,
    "cell": CellParameters,
    "joints": JointParameters,
    "process": ProcessParameters,
    "program": ProgramParameters,
}
RARE_SECTIONS = {
    "place": PlaceParameters,
    "substrate": ScanParameters,
}  # sections that few jobs have,
LATER_BY = {
    "place": {"points", "proven"},
    "substrate": {"scan"},
}  # and their keys
STRATEGIES = {kind: family.parameters for kind, family in families.KINDS.items()}
OTHER_KEYS = (
    "version",
    "name",
    "part.file",
    "part.object",
    "part.faces",
    "part.start_edges",
    "part.scale",
    "part.set",
    "fixtures",
    "substrate.file",
    "substrate.faces",
    "strategy.kind",
)
SCAN_KEYS = {
    "substrate.scan_unit": ("auto", "mm", "cm", "m", "um", "inch"),
    "substrate.scan_fit": ("auto", "best", "none"),
    "substrate.scan_pairs": (
        "0 0 0 > 0 0 0; 9 0 0 > 9 0 0; 0 9 0 > 0 9 0",
        "20 20 0 > 20 20 0.3",
        "1 2 > 3",
    ),
}
# fmt: off
ODD = (
    None, True, False, [], {}, "", " ", "auto", "none", "nan", ".nan", math.nan, math.inf, -math.inf, 0, -1, 1e308,
    1e-308, 10**30, 10**400, -0.0, "1e999", "1 kg", "1 mm mm", "mm", "5 °C", "1,5 mm", "1/0 mm", "１２ mm", "∞ mm", "π rad",
    "é", "日本", "\u202e", "\x00", "\x1b[2J", "a\nb", "\ufeff", "\ud83d\ude00", "../../etc/passwd", "$(id)", "%s%n",
    "x" * 5000, [1, 2, 3], [[[[]]]], {"a": {"b": 1}}, "2020-01-01", "0x10", "0o17", "1_000", "=1+1", "90 deg", "1 mm",
    "6 mm/s", "50 %", "-5 mm", "0 mm", "1e9 mm", "1e-9 mm", "1e-5 mm", "1 rad/mm", "(1+2)^3 mm", "sqrt(-1) mm",
    "1e5^1e5 mm", "1" * 400, "Face1", ["Face1", "Face99"], [None] * 6, [0] * 6, [1e9] * 6, ["1 mm"] * 6,
    list(range(1000)), "front up flip", ["front"], "~", "[", "- a",
)
PATHS = (
    "", ".", "..", "/", "/dev/null", "/dev/zero", "nowhere.step", "nowhere", "job.yaml", "~/x.step", "a\x00b.step",
    "x" * 300 + ".step", "cup.step/..", "cup.step/cup.step", "./cup.step", "../parts/cup.step", "cup.STEP", "cup.igs",
    "hub.stl", "boxes.stl", "block.csv", "block.xyz", "block.ply", "block.stl", "beads.csv", "parts.FCStd", "tube.brep",
    "boxes.brep", "hub.step", "block.step", "file:///cup.step", "cup.step\n", "кубок.step", "*.step",
)
PUT_IN = (
    b"\t", b"  ", b":", b"- ", b"#", b"\r", b"&a ", b"*a ", b"!!python/object:os.system ", b"{", b"]", b"\xef\xbb\xbf",
    b"\xc3\xa9", b"|\n", b"? ", b"---\n", b"%YAML 9.9\n", b"'", b'"', b"\x00",
)
# fmt: on


def mutated(base, chance, folder):
    """Return the text in bytes of a job like `base` with one to three mutations; `folder` has the
    small parts."""
    job = copy.deepcopy(base)
    kind = chance.choices(("valid", "values", "structure", "text"), (6, 5, 3, 4))[0]
    if kind == "valid":
        if chance.random() < 0.3:  # only the toolpath
            job.pop("cell", None), job.pop("program", None), job.pop("joints", None)
        for _ in range(chance.randint(1, 4)):
            put(job, *_valid(job, chance))
        return _dump(job)
    if kind == "values":
        for _ in range(chance.randint(1, 2)):
            put(job, *_odd(job, chance, folder))
        return _dump(job)
    if kind == "structure":
        return _restructured(job, chance)
    return damaged_text(_dump(job), chance)


def put(job, key, value):
    """Set the value of a dotted key, if its parent is a section."""
    *above, leaf = key.split(".")
    section = job
    for name in above:
        if not isinstance(section.get(name), dict):
            section[name] = {}
        section = section[name]
    section[leaf] = value


def specs(job):
    """Return (dotted key, Spec, default) of all parameters that the job may have."""
    kind = str(job.get("strategy", {}).get("kind", "revolution"))
    # an earlier mutation may have changed the kind
    kind = kind if kind in STRATEGIES else "revolution"
    own_specs = {
        name: factory
        for name, factory in RARE_SECTIONS.items()
        if _section(job, name).keys() & LATER_BY[name]
    }
    return [
        entry
        for name, factory in {"strategy": STRATEGIES[kind], **SECTIONS, **own_specs}.items()
        for entry in _specs(factory, name)
    ]


def _section(job, name):
    return job[name] if isinstance(job.get(name), dict) else {}


def _specs(factory, prefix):
    for field in dataclasses.fields(factory):
        spec = f.spec_of(field)
        if spec.kind == f.GROUP:
            yield from _specs(field.default_factory, f"{prefix}.{field.name}")
        else:
            default = field.default if field.default is not dataclasses.MISSING else None
            yield f"{prefix}.{field.name}", spec, default


def _valid(job, chance):
    """Return a key and a plausible value for it."""
    if "scan" in _section(job, "substrate") and chance.random() < 0.2:
        key = chance.choice(list(SCAN_KEYS))
        return key, chance.choice(SCAN_KEYS[key])
    if chance.random() < 0.15:
        return "process.classes", _classes(chance)
    while True:
        key, spec, default = chance.choice(specs(job))
        if key in (
            "cell.machine",
            "cell.setup",
            "process.bead_model",
        ) or spec.kind in (f.TEXT, f.RECORDS, f.VECTOR):
            continue
        return key, valid_value(key, spec, default, chance)


def _classes(chance):
    """Return some classes of beads with keys of their own."""
    classes = {}
    for name in chance.sample(bead_classes.CLASSES, chance.randint(1, 3)):
        classes[name] = {}
        for key in chance.sample(list(bead_classes.SPECS), chance.randint(1, 4)):
            phase, _, inner = key.partition("_")
            value = valid_value(key, bead_classes.SPECS[key], 3.0, chance)
            if phase in (bead_classes.START, bead_classes.END):
                classes[name].setdefault(phase, {})[inner] = value
            else:
                classes[name][key] = value
    return classes


def valid_value(key, spec, default, chance):
    """Return a value in the range of a parameter, in the form of a job file."""
    if spec.words and chance.random() < 0.3:
        return chance.choice(spec.words)
    if spec.optional and chance.random() < 0.2:
        return None
    if key in ("strategy.layer_height", "strategy.bead_spacing"):
        return f"{chance.uniform(3.0, 25.0):.3g} mm"
    if key == "strategy.chord_error":
        return f"{10 ** chance.uniform(-1.3, 0.5):.3g} mm"
    if spec.kind == f.CHOICE:
        return chance.choice(spec.choices)
    if spec.kind == f.FLAG:
        return chance.random() < 0.5
    if spec.kind == f.POSE or (isinstance(default, tuple) and len(default) == 6):
        start = default if isinstance(default, tuple) else (0.0,) * 6
        return [round(number + chance.gauss(0.0, 100.0), 3) for number in start[:3]] + [
            round(chance.uniform(-180.0, 180.0), 3) for _ in range(3)
        ]
    if spec.kind == f.ANGLE_RANGE:
        return sorted(round(chance.uniform(-180.0, 180.0), 2) for _ in range(2))
    if spec.kind == f.RATIO_RANGE:
        return sorted(round(chance.uniform(40.0, 200.0), 1) for _ in range(2))
    scale = 1.0 / f.TO_INNER.get(spec.kind, 1.0)
    low = (-180.0 if spec.kind == f.ANGLE else 0.0) if spec.low is None else spec.low * scale
    high = low + 360.0 if spec.high is None else spec.high * scale
    if spec.kind == f.COUNT:
        return chance.randint(int(low), int(min(high, low + chance.choice((3, 60)))))
    if (
        spec.kind != f.ANGLE
        and isinstance(default, (int, float))
        and not isinstance(default, bool)
        and default > 0.0
    ):
        number = default * scale * 10 ** chance.uniform(-1.0, 1.0)
    else:
        number = chance.choice((low, high, chance.uniform(low, high), chance.uniform(low, high)))
    number = float(f"{min(max(number, low), high):.4g}")
    unit = f.OUTER_UNIT.get(spec.kind, "")
    return f"{number:g} {unit}" if unit and chance.random() < 0.7 else number


def _odd(job, chance, folder):
    """Return a key and a value that is rarely valid."""
    choice_ = chance.choice([*specs(job), *((key, None, None) for key in _others(job))])
    key, spec, _ = choice_
    if key in ("process.classes", "cell.external") and chance.random() < 0.8:
        return key, _odd_entries(job, key, chance, folder)
    if key.endswith((".file", ".scan")) or (
        key in ("cell.machine", "process.bead_model") and chance.random() < 0.7
    ):
        name = chance.choice(PATHS)
        return key, f"{folder}/{name}" if chance.random() < 0.6 else name
    if spec is not None and spec.low is not None and chance.random() < 0.3:
        return key, chance.choice(
            (1.0, 1.0 - 1e-12, 1.0 + 1e-12, 0.999, 1e-6)
        ) * spec.low / f.TO_INNER.get(spec.kind, 1.0)
    if spec is not None and spec.high is not None and chance.random() < 0.3:
        return key, chance.choice(
            (1.0, 1.0 - 1e-12, 1.0 + 1e-12, 1.001, 1e6)
        ) * spec.high / f.TO_INNER.get(spec.kind, 1.0)
    if key == "fixtures":
        unrelated = {"file": "x.step", "faces": ["Face1"]}
        return key, chance.choice(
            ([], {}, [{}], [{"file": f"{folder}/block.step"}], [unrelated], "x", [None])
        )
    if key == "part.set":
        properties = {"Radius": "9 mm"}, {"Shape": 1}, {}, {"Radius": [1]}
        return key, chance.choice(
            (*({name: chance.choice(properties)} for name in ("Cylinder", "Cup", "x")), "x")
        )
    return key, chance.choice(ODD)


def _others(job):
    """Return keys that no dataclass has."""
    return (
        (*OTHER_KEYS, "substrate.scan", *SCAN_KEYS)
        if "scan" in _section(job, "substrate")
        else OTHER_KEYS
    )


def _odd_entries(job, key, chance, folder):
    """Return classes, or external axes, with a rarely valid entry."""
    if key == "process.classes":
        entries = _classes(chance)
        name = chance.choice(list(entries))
        inner = chance.choice((*bead_classes.SPECS, "start", "end", "length", "classes"))
        entries[chance.choice((name, name, "seam", ""))] = {inner: chance.choice(ODD)}
        return entries
    name, parent = (
        chance.choice(("machine", "pose", "carries", "x")),
        _section(job, "cell").get("external"),
    )
    entries = (
        copy.deepcopy(parent)
        if isinstance(parent, list) and parent
        else [
            {"machine": "kuka-kl100-2", "pose": [0, 0, -356, 0, 0, 90], "carries": "robot"},
        ]
    )
    if not isinstance(entries[0], dict) or chance.random() < 0.2:
        return entries * chance.randint(2, 4)
    odd = (
        *ODD,
        "robot",
        "part",
        "kuka-kl100-2",
        "ur-ur10e",
        "table-xyzac",
        f"{folder}/{chance.choice(PATHS)}",
    )
    entries[0][name] = chance.choice(odd)
    return entries


def _restructured(job, chance):
    """Remove, move, misspell, duplicate or wrap sections and keys."""
    for _ in range(chance.randint(1, 3)):
        sections = [job, *(section for section in job.values() if isinstance(section, dict))]
        section = chance.choice([section for section in sections if section] or [job])
        key = chance.choice(list(section) or ["part"])
        value = section.get(key)
        kind_ = chance.randrange(7)
        if kind_ == 0:
            section.pop(key, None)
        elif kind_ == 1:
            index = chance.randrange(len(key) + 1)
            section[
                key[:index] + chance.choice("abz_- éß\u00a0") + key[index + chance.randint(0, 1) :]
            ] = section.pop(key, None)
        elif kind_ == 2:
            chance.choice(sections)[key] = value
        elif kind_ == 3:
            section[key] = [value]
        elif kind_ == 4:
            for _ in range(chance.choice((1, 5, 19, 40))):
                value = {key: value}
            section[key] = value
        elif kind_ == 5:
            section[
                chance.choice(
                    ("x", "", "part.file", "<<", "=", "null", "1", "é", "\u2028", "x" * 3000)
                )
            ] = value
        else:
            section[key] = chance.choice(ODD)
    return _dump(job)


def damaged_text(data, chance):
    """Change bytes, signs and lines of a text."""
    for _ in range(chance.randint(1, 4)):
        start, end = chance.randrange(max(1, len(data))), chance.randrange(max(1, len(data)))
        low, high = sorted((start, end))
        lines = data.split(b"\n")
        row = chance.randrange(len(lines))
        kind_ = chance.randrange(12)
        if kind_ == 0:
            data = data[:start]
        elif kind_ == 1:
            data = data[:start] + bytes([chance.randrange(256)]) + data[start + 1 :]
        elif kind_ == 2:
            data = data[:start] + chance.choice(PUT_IN) + data[start:]
        elif kind_ == 3:
            data = b"\n".join([*lines[:row], *lines[row + 1 :]])
        elif kind_ == 4:
            data = b"\n".join([*lines[:row], lines[row], *lines[row:]])
        elif kind_ == 5:
            chance.shuffle(lines)
            data = b"\n".join(lines)
        elif kind_ == 6:
            digits = [k for k, sign in enumerate(data) if sign in b"0123456789"]
            if digits:
                match = chance.choice(digits)
                data = (
                    data[:match]
                    + chance.choice((b"-", b"9", b"0", b"e", b".", b"1e", b"999"))
                    + data[match + 1 :]
                )
        elif kind_ == 7:
            data = data[:low] + data[high:]
        elif kind_ == 8:
            data = data[:high] + data[low:]
        elif kind_ == 9:
            coding = chance.choice(("utf-16", "latin-1", "utf-7", "utf-8-sig"))
            data = data.decode("utf-8", "replace").encode(coding, "replace")
        elif kind_ == 10:
            data = data.replace(
                b"\n", chance.choice((b"\r\n", b"\r", b"\n\n", b"\x0b", b"\xe2\x80\xa8"))
            )
        else:
            unit = chance.choice((b" m", b" in", b"mm", b" um", b" km", b" deg", b""))
            data = data.replace(b" mm", unit, chance.randint(1, 3))
    return data


def _dump(job):
    """Return the job as YAML, or as JSON, which YAML reads, where YAML cannot write it."""
    try:
        return yaml.safe_dump(job, allow_unicode=True, sort_keys=False).encode(
            "utf-8", "surrogatepass"
        )
    except (yaml.YAMLError, UnicodeError):
        return json.dumps(job).encode()
