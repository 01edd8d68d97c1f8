# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every message of an error says what to do: a clause of it begins with a verb that asks for something."""

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "freecad_am"
ERRORS = ("AmError", "InputError", "InfeasibleError")
HELPERS = ("bad", "_error", "_refuse")  # make errors of their first argument
VERBS = (
    "add", "allow", "ask", "call", "change", "check", "choose", "close", "compare", "copy", "correct", "cover", "cut",
    "deposit", "divide", "draw",
    "end", "enter", "export", "fill", "flip", "free", "fuse", "give", "include", "install", "keep", "lay", "leave", "let",
    "look", "lower",
    "make", "measure", "mend", "merge", "model", "mount", "move", "name", "open", "orient", "pass", "pick", "plan", "put",
    "raise",
    "rebuild", "recompute", "remove", "rename", "repair", "run", "save", "say", "see", "select", "separate", "set",
    "simplify", "split", "start", "take",
    "tell", "touch", "try", "turn", "use", "wait", "write",
)
BEFORE = r"(?:^|[;:,?.(] ?(?:or |and |then |first |elsewhere |do not )*|\b(?:or|and) )"
ASKS = re.compile(rf"{BEFORE}(?:{'|'.join(VERBS)})\b|did you mean", re.IGNORECASE)
INNER = ("message", "no_arm")  # values that are the messages of other errors
EXCEPTIONS = {
    "{}; {}",  # of the platform: what is wrong and its remedy, both given
    "{}: {} edges, the first at {}; {}",  # of a mesh: both from a table
    "{!r} is not understood; {}",  # of a field of the window, its remedy given
    # a command to type
    "solids are filled with the Python package shapely (1.8 or newer), which is not installed; on Debian: apt-get install "
    "python3-shapely, elsewhere: pip install shapely",
}


def called(call):
    return getattr(call.func, "attr", getattr(call.func, "id", ""))


def texts(node):
    return [part.value for part in ast.walk(node) if isinstance(part, ast.Constant) and isinstance(part.value, str)]


class Code:
    """Files, and what names in a message stand for: what the same file gives them, and constants of all."""

    def __init__(self, trees):
        self.constants, self.local, self.calls = defaultdict(set), {}, {}
        for path, tree in trees.items():
            known, calls = defaultdict(set), []
            self.local[path], self.calls[path] = known, calls
            for node in ast.walk(tree):
                if isinstance(node, ast.Call) and called(node) in (*ERRORS, *HELPERS):
                    calls.append(node)
                if isinstance(node, ast.Assign):
                    for target in node.targets:
                        name = getattr(target, "id", "")
                        (self.constants if name.isupper() else known)[name].update(texts(node.value))
                elif isinstance(node, ast.FunctionDef):
                    known[node.name].update(text for one in ast.walk(node) if isinstance(one, ast.Return) and one.value
                                            for text in texts(one.value))

    def said(self, node, path):
        """Texts that an expression can put into a message."""
        found = set(texts(node))
        for part in ast.walk(node):
            name = getattr(part, "id", getattr(part, "attr", ""))
            found |= self.constants.get(name, set()) | self.local[path].get(name, set())
        return found

    def messages(self):
        """Place, template and all that may be said with it, of each message of an error that stands where it is raised;
        those that put in the message of another error left out."""
        for path, calls in self.calls.items():
            for call in calls:
                at = 2 if called(call) in ERRORS else 0
                if len(call.args) <= at or not texts(call.args[at]):
                    continue
                if not any(getattr(part, "attr", "") in INNER for value in call.args[at:] for part in ast.walk(value)):
                    said = set().union(*(self.said(value, path) for value in call.args[at:]))
                    yield f"{path}:{call.lineno}", texts(call.args[at])[0], said


def silent(code):
    return {f"{place} {template}" for place, template, said in code.messages()
            if template not in EXCEPTIONS and not any(map(ASKS.search, said))}


@pytest.fixture(scope="module")
def package():
    return Code({path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
                 for path in sorted(PACKAGE.rglob("*.py"))})


def test_errors_say_what_to_do(package):
    assert len(list(package.messages())) > 700
    assert silent(package) == set(), "add what to do: '{} is not a number; write one such as 12.5'"


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ('InputError("A", b, "{} is not a number", c)', ["{} is not a number"]),
        ('InputError("A", b, "the set {!r} is missing in the plan", c)', ["the set {!r} is missing in the plan"]),
        ('raise node.bad(Text("{} is no list", c))', ["{} is no list"]),
        ('why = "it is turned"\nInputError("A", b, "{}: {}", c, why)', ["{}: {}"]),
        ('InputError("A", b, "{} is not a number; write one such as 12.5", c)', []),
        ('FORM = "give x,y,z"\nInputError("A", b, "{} is wrong; {}", c, FORM)', []),
        ('InputError("A", b, "feature {}: {}", c, error.message)', []),
    ],
)
def test_messages_that_do_not_say_it_are_found(text, wanted):
    assert [template for _, template, said in Code({"a.py": ast.parse(text)}).messages()
            if not any(map(ASKS.search, said))] == wanted


def test_exceptions_are_needed(package):
    wanting = {template for _, template, said in package.messages() if not any(map(ASKS.search, said))}
    assert wanting >= EXCEPTIONS, "say what to do by now: take these off the list"
