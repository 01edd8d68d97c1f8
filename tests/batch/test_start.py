# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a process that plans asks of the system: what it has freed it takes again, and what it does not need it leaves."""

import platform
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

FAULTS = """
import resource, sys
from freecad_am.batch import allocation
if sys.argv[1:]:
    allocation.keep_freed()
block = b"x" * 100_000_000
del block
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
block = b"x" * 90_000_000
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other libraries ask in ways of their own")
def test_freed_memory_is_taken_again():
    def faults(*asked):
        return int(subprocess.run(
            [sys.executable, "-c", FAULTS, *asked], capture_output=True, text=True, check=True, cwd=ROOT
        ).stdout)

    assert faults("kept") < 1000 < faults()


LOADED = """
import os, sys
from freecad_am.batch import cli, host
host.find_freecad()
status = cli._main(["plan", *sys.argv[1:], "--no-page"])
slow = {"matplotlib", "shapely", "scipy.interpolate", "scipy.optimize", "freecad_am.gui", "freecad_am.plots"}
print(status, *sorted(slow & set(sys.modules)), flush=True)
os._exit(0)
"""
JOB = """version: 1
name: small
part: {{file: {part}}}
strategy: {{kind: revolution, layer_height: 5 mm, chord_error: 0.1 mm}}
cell: {{machine: fanuc-arcmate120ic, limits: paper, deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0],
       platform: 5 mm, branch: [front, up, flip]}}
process: {{travel_speed: 6 mm/s}}
program: {{post: fanuc}}
"""


def test_a_part_of_revolution_loads_nothing_slow_that_others_need(tmp_path):
    job = tmp_path / "job.yaml"
    job.write_text(JOB.format(part=ROOT / "resources" / "examples" / "hemisphere.step"))
    ran = subprocess.run(
        [sys.executable, "-c", LOADED, str(job), "-o", str(tmp_path / "out")], capture_output=True, text=True, check=True,
        cwd=ROOT,
    )
    assert ran.stdout.split("\n")[-2] == "0"


PUT_OFF = """
import dataclasses, sys
from freecad_am.batch import late
create, made = dataclasses._create_fn, []
dataclasses._create_fn = lambda name, args, body, *, globals=None, locals=None, return_type=dataclasses.MISSING: (
    made.append(name), create(name, args, body, globals=globals, locals=locals, return_type=return_type))[1]
if sys.argv[1:]:
    late.functions_of_dataclasses()

@dataclasses.dataclass(frozen=True, order=True)
class One:
    "A class."
    number: int
    words: list = dataclasses.field(default_factory=list, compare=False)
    more: dataclasses.InitVar[int] = 2
    twice: int = dataclasses.field(init=False, default=0)

    def __post_init__(self, more):
        object.__setattr__(self, "twice", more * self.number)

@dataclasses.dataclass
class Other(One.__base__):
    text: str
    rest: str = "r"

unused = list(made)

def told(act):
    try:
        return repr(act())
    except Exception as error:
        return f"{type(error).__name__} {error}"

one, same, more = One(3), One(3, ["a"], more=2), One(4, more=5)
print(one, same, more, one == same, one == more, one < more, one >= more, hash(one) == hash(same), {one: 1}[same])
print(dataclasses.replace(one, number=7, more=3), dataclasses.asdict(more), dataclasses.astuple(Other("t")))
print(Other("t") == Other("t"), Other("t") != Other("u"))
print(*map(told, (lambda: One(), lambda: One(1, 2, 3, 4), lambda: One(1, other=2), lambda: setattr(one, "number", 1),
                  lambda: delattr(one, "number"), lambda: Other(), lambda: hash(Other("t")), lambda: one < 3)), sep="; ")
print(One.__init__.__qualname__, One.__repr__.__name__, One.__init__.__name__, one.words is not One(3).words)
print(len(unused), file=sys.stderr)
"""


@pytest.mark.skipif(sys.version_info >= (3, 13), reason="Python makes them in another way")
def test_functions_of_dataclasses_that_are_compiled_when_they_are_called_do_the_same():
    at_once, later = (
        subprocess.run([sys.executable, "-c", PUT_OFF, *words], capture_output=True, text=True, check=True, cwd=ROOT)
        for words in ((), ("late",))
    )
    assert at_once.stdout == later.stdout and "One(number=3" in later.stdout and "FrozenInstanceError" in later.stdout
    assert "missing 1 required positional argument" in later.stdout
    assert int(at_once.stderr) > 8 and later.stderr == "0\n"


WHEN_USED = """
import sys
from freecad_am.batch import late
late.modules()
from scipy.spatial import cKDTree
print("scipy.sparse.csgraph._laplacian" in sys.modules, "scipy.spatial.transform._rotation" in sys.modules)
from scipy.sparse import coo_matrix, csgraph
from scipy.spatial import transform
print("scipy.sparse.csgraph._laplacian" in sys.modules)
print(csgraph.connected_components(coo_matrix(([1], ([0], [2])), shape=(4, 4)), directed=False)[1].tolist())
print(transform.Rotation.from_euler("z", 90, degrees=True).apply([1, 0, 0]).round(6).tolist())
from scipy.sparse.csgraph import dijkstra
print(dijkstra(coo_matrix(([2.5], ([0], [1])), shape=(2, 2)).tocsr())[0, 1])
"""


def test_what_scipy_names_in_passing_is_loaded_when_it_is_used():
    ran = subprocess.run([sys.executable, "-c", WHEN_USED], capture_output=True, text=True, check=True, cwd=ROOT)
    assert ran.stdout.split("\n")[:-1] == ["False False", "False", "[0, 1, 0, 2]", "[0.0, 1.0, 0.0]", "2.5"]
