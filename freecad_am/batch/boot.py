# SPDX-License-Identifier: LGPL-2.1-or-later
"""Started by the launcher: looks whether this Python serves, and runs the command in the same process.

Ends with status 97 when FreeCAD, numpy, scipy or yaml is missing, so that the launcher tries the next Python. Runs in
plain Python and in freecadcmd, which imports a script as a module, may run it twice after an exception and ends
with 0 then: nothing is let out of here.
"""

import os
import sys

UNFIT = 97
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def arguments():
    """The words after the script, however the host passes them."""
    return sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv and "FREECAD_AM_ROOT" in os.environ else sys.argv[1:]


def run(words):
    """The exit status of a command, UNFIT when this Python cannot run it."""
    folder = os.path.dirname(os.path.abspath(__file__))
    sys.path[:] = [ROOT] + [entry for entry in sys.path if os.path.abspath(entry or ".") != folder]
    sys.dont_write_bytecode = sys.dont_write_bytecode or not os.access(folder, os.W_OK)
    from freecad_am.batch import host

    if host.missing_modules():
        return UNFIT
    if words[:1] == ["ready"]:
        import importlib.util

        return 0 if importlib.util.find_spec("PyKDL") else 1
    from freecad_am.batch import cli

    if words[:1] == ["demo"]:
        example = os.path.join(ROOT, "resources", "examples", "hemisphere.yaml")
        words = ["plan", example, "-o", os.path.join("out", "hemisphere"), *words[1:]]
    return cli.main(words)


def main():
    """Run and end the process with the status; FreeCAD's own clean-up at exit is not waited for."""
    status = 1
    try:
        status = run(arguments())
    except KeyboardInterrupt:
        status = 130
    except BaseException:  # freecadcmd would run the script again
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


main()
