# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document may name any module to import, so importing a module of the package must only define
names."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# imports each named module and reports side effects; modules of FreeCAD's window and optional ones
# may be missing
CHILD = """
import importlib, os, sys, threading
sys.path.insert(0, sys.argv[1])
from freecad_am.batch import host
host.find_freecad()
import FreeCAD, Part, numpy, scipy.optimize, scipy.spatial, scipy.sparse, matplotlib, shapely, yaml
import subprocess, multiprocessing, matplotlib.backends.backend_agg, matplotlib.backends.backend_svg, xml.parsers.expat
done, watched = [], []
def heard(event, given):
    if not watched:
        return
    if event == "open" and isinstance(given[1], str) and given[1][:1] in "wax+" or event in (
        "os.system", "os.exec", "os.fork", "os.forkpty", "os.posix_spawn", "os.spawn", "subprocess.Popen", "os.remove",
        "os.rename", "os.mkdir", "os.rmdir", "os.chdir", "os.kill", "shutil.rmtree", "socket.connect", "tempfile.mkdtemp",
        "tempfile.mkstemp", "signal.pthread_kill",
    ):
        if not str(given[0]).endswith((".pyc", "__pycache__")) and ".pyc." not in str(given[0]):
            done.append((watched[0], event, str(given)[:200]))
sys.addaudithook(heard)
missing = []
for name in sys.argv[2:]:
    before = (os.getcwd(), threading.active_count(), list(sys.argv), FreeCAD.listDocuments().keys())
    watched[:] = [name]
    try:
        importlib.import_module(name)
    except ImportError as error:
        if not any(word in str(error) for word in ("FreeCADGui", "PySide", "pivy", "matplotlib", "Qt", "shiboken", "fcl")):
            raise
        missing.append(name)
    watched.clear()
    if before != (os.getcwd(), threading.active_count(), list(sys.argv), FreeCAD.listDocuments().keys()):
        done.append((name, "state", ""))
sys.stdout.write("DONE " + repr(done) + " MISSING " + str(len(missing)))
sys.stdout.flush()
os._exit(7)
"""


def names():
    for path in sorted((ROOT / "freecad_am").rglob("*.py")):
        yield ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def test_importing_a_module_runs_prints_and_ends_nothing(tmp_path):
    process = subprocess.run(
        [sys.executable, "-B", "-c", CHILD, str(ROOT), *names()],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        stdin=subprocess.DEVNULL,
    )
    assert process.returncode == 7, (process.returncode, process.stdout, process.stderr[-3000:])
    assert process.stdout.startswith("DONE [] MISSING "), (process.stdout, process.stderr)
    assert process.stderr == ""
    assert not list(tmp_path.iterdir())
