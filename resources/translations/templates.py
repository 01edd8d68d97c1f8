# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts that the code makes, read from its syntax trees: the templates that are written where a message is made,
`Text("it has {} faces", n)`, one for each choice of words; and plain texts that become a message as they are.

For these are followed arguments that a function passes on to a message, values that functions return, local variables and
constants.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from itertools import count, product
from string import Formatter
from typing import Any

from sources import ROOT, Code, Function, Module, assigned, called, calls_in, walked

# what of a call is told to the user: positions of its arguments
MAKERS: dict[str, set[int]] = {
    "AmError": {1, 2},
    "InputError": {1, 2},
    "InfeasibleError": {1, 2},
    "Issue": {2},
    "report": {1},
    "progress": {1},
    "Band": {0},
    "Row": {0, 3},
    "Patch": {3},
    "Chart": {0},
    "Quantity": {0},
    "Curve": {0},
    "Entry": {0},
    "Promise": {0, 1},
    "Proposal": {1},
    "Refusal": {0},
    "carry_out": {2},
    "controller_checks": set(range(8)),
}
PROPERTY = "Message"  # of stages: what it is set to is told
KEYWORDS = {"message", "where", "lacking", "text", "label", "short", "name"}
ERRORS = ("AmError", "InputError", "InfeasibleError")
_MOST_CASES = 16
_DEPTH = 11
UNITS = {"mm", "deg", "mm2", "cm3", "min", "kg"}
_FORM = re.compile(r"\{\d*(![rs])?(:[^{} ]*)?\}")  # of a place in a template
_WORD = re.compile(r"[^\W\d_]{2,}")
# neither a text nor what holds some
_OPAQUE = {
    "len",
    "round",
    "float",
    "int",
    "sum",
    "max",
    "min",
    "abs",
    "degrees",
    "repr",
    "type",
    "set",
    "range",
}

Case = list[str | None]  # parts of a text, None for each place


class Templates:
    """All templates of some code."""

    def __init__(self, code: Code, titles: tuple[str, ...] = ()) -> None:
        """titles: files where single words are told too."""
        self.code, self.titles = code, titles
        self.makers = {name: set(positions) for name, positions in MAKERS.items()}
        self.found: dict[str, str] = {}  # template: where it is first made
        self.lost: set[str] = (
            set()
        )  # f-strings that reach a message, which forget what they were made of
        self._seen: set[tuple[int, int]] = set()
        self._inlined: set[int] = (
            set()
        )  # texts that are words of others, and those that are told by themselves
        self._told_by_flow: set[int] = set()
        while self._learn():
            pass
        for module in code.modules:
            for node, texts in self._telling(module):
                for text in texts:
                    self._collect(text, module, module.around[id(node)], _DEPTH)
        made = [
            (case, module, call)
            for module in code.modules
            for call in calls_in(module.tree)
            for case in self._made(call, module)
        ]
        for case, module, call in made:
            if id(call) in self._told_by_flow or id(call) not in self._inlined:
                self._add(case, module, made=True)

    # ---- which functions pass on a message

    def _telling(self, module: Module) -> Iterator[tuple[ast.AST, list[ast.expr]]]:
        """The nodes that tell something, calls and settings of a stage's message, with what they tell."""
        for node in _tellers(module.tree):
            if isinstance(node, ast.Assign):
                yield node, [node.value]
            elif called(node) in self.makers:
                yield node, self._told(node)

    def _told(self, call: ast.Call) -> list[ast.expr]:
        """The arguments of a call that are told."""
        if called(call) in ERRORS:  # with the values of the message
            told = call.args[1:2] + call.args[3 if len(call.args) > 3 else 2 :]
        else:
            told = [
                argument for at, argument in enumerate(call.args) if at in self.makers[called(call)]
            ]
        return told + [keyword.value for keyword in call.keywords if keyword.arg in KEYWORDS]

    def _learn(self) -> bool:
        """Add functions that put a parameter into a message; False when there are no more."""
        before = sum(map(len, self.makers.values()))
        for module in self.code.modules:
            for teller, texts in self._telling(module):
                function = module.around[id(teller)]
                if function is None:
                    continue
                names = [one.arg for one in function.args.args]
                names = names[1:] if names[:1] in (["self"], ["cls"]) else names
                used = {
                    node.id
                    for text in texts
                    for node in ast.walk(text)
                    if isinstance(node, ast.Name)
                }
                for at, name in enumerate(names):
                    if name in used and (self._is_text(function, name) or _is_list(function, name)):
                        self.makers.setdefault(function.name, set()).add(at)
        return sum(map(len, self.makers.values())) > before

    @staticmethod
    def _is_text(function: Function, name: str) -> bool:
        note = next(one.annotation for one in function.args.args if one.arg == name)
        return isinstance(note, ast.Name) and note.id == "str"

    # ---- what a told expression can be

    def _collect(
        self, node: ast.AST | None, module: Module, function: Function | None, depth: int
    ) -> None:
        if node is None or depth == 0 or (id(node), depth) in self._seen:
            return
        self._seen.add((id(node), depth))
        if isinstance(node, ast.Constant):
            if isinstance(node.value, str):
                parts = _parts(node.value) if _FORM.search(node.value) else [node.value]
                self._add([part if isinstance(part, str) else None for part in parts], module)
        elif isinstance(node, ast.JoinedStr):
            literal = "".join(
                part.value if isinstance(part, ast.Constant) else "{0}" for part in node.values
            )
            if says_something(literal):
                self.lost.add(f"{module.path.relative_to(ROOT)}:{node.lineno} {literal}")
        elif isinstance(node, ast.BinOp):
            self._collect(node.left, module, function, depth - 1)
            self._collect(node.right, module, function, depth - 1)
        elif isinstance(node, ast.Call):
            self._collect_call(node, module, function, depth)
        elif isinstance(node, ast.Name):
            self._collect_name(node.id, module, function, depth)
        elif isinstance(node, ast.Attribute):
            for where, value in self.code.constants.get(node.attr, []):
                self._collect(value, where, None, depth - 1)
        elif isinstance(node, ast.Subscript):
            self._collect(node.value, module, function, depth - 1)
        elif isinstance(node, ast.IfExp):
            self._collect(node.body, module, function, depth - 1)
            self._collect(node.orelse, module, function, depth - 1)
        elif isinstance(node, (ast.ListComp, ast.GeneratorExp, ast.SetComp)):
            self._collect(node.elt, module, function, depth - 1)
            for loop in node.generators:
                self._collect(loop.iter, module, function, depth - 1)
        elif isinstance(node, ast.Dict):
            for part in (*node.keys, *node.values):
                self._collect(part, module, function, depth - 1)
        elif isinstance(node, (ast.Tuple, ast.List, ast.Set, ast.BoolOp, ast.Starred)):
            for child in ast.iter_child_nodes(node):
                self._collect(child, module, function, depth - 1)

    def _collect_call(
        self, node: ast.Call, module: Module, function: Function | None, depth: int
    ) -> None:
        name = called(node)
        if name == "Word":  # a part of a template
            return
        if name in ("Text", "joined"):
            self._told_by_flow.add(id(node))
            for argument in node.args[_is_made(node) :]:  # that is found where it stands
                self._collect(argument, module, function, depth - 1)
            return
        if name in _OPAQUE or name in self.makers:
            return
        if isinstance(node.func, ast.Attribute):
            self._collect(
                node.func.value, module, function, depth - 1
            )  # text.strip(), names.get(key)
            if name in ("join", "get"):
                for argument in node.args:
                    self._collect(argument, module, function, depth - 1)
        for where, made in self.code.functions.get(name, []):
            for statement in walked(made):
                if (
                    isinstance(statement, (ast.Return, ast.Yield))
                    and where.around.get(id(statement)) is made
                ):
                    self._collect(statement.value, where, made, depth - 1)

    def _collect_name(
        self, name: str, module: Module, function: Function | None, depth: int
    ) -> None:
        own = [] if function is None else _values(name, function)
        for value in own:
            self._collect(value, module, function, depth - 1)
        filled = [] if function is None else list(self._filled(name, function))
        for where, other, parameter in filled:
            self._collect_name(parameter, where, other, depth - 1)
        if not own and not filled:
            for where, value in self.code.constants.get(name, []):
                self._collect(value, where, None, depth - 1)

    def _filled(self, name: str, function: Function) -> Iterator[tuple[Module, Function, str]]:
        """The functions that get a list to put texts into, and what they call it."""
        for call in calls_in(function):
            for at, argument in enumerate(call.args):
                if getattr(argument, "id", "") == name:
                    for where, other in self.code.functions.get(called(call), []):
                        names = [one.arg for one in other.args.args]
                        if at < len(names) and other is not function and _is_list(other, names[at]):
                            yield where, other, names[at]

    # ---- texts that are made

    def _made(self, call: ast.Call, module: Module) -> list[Case]:
        """What a call makes, where it is written there: a Text, an error with a message, texts that are joined."""
        texts = (
            call.args[2:] if called(call) in ERRORS else call.args if called(call) == "Text" else []
        )
        if called(call) == "joined" and isinstance(call.args[0], ast.Constant):
            return [[None, call.args[0].value, None]]
        first = texts[:1] if len(texts) > 1 or called(call) == "Text" else []
        return (
            [
                case
                for text in ast.walk(first[0])
                if isinstance(text, ast.Constant) and isinstance(text.value, str)
                for case in self._cases(text.value, texts[1:], module.around[id(call)])
            ]
            if first
            else []
        )

    def _cases(self, text: str, values: list[ast.expr], function: Function | None) -> list[Case]:
        """What a template can be, one for each choice of its words."""
        found: list[Case] = [[]]
        for part in _parts(text):
            cases: list[Case] = [[part]]
            if isinstance(part, int):
                value = values[part]
                chosen = isinstance(value, ast.Call) and called(value) == "Word"
                cases = self._words(value.args[0], function) if chosen else [[None]]
            found = [[*before, *case] for before, case in product(found, cases)]
            if len(found) > _MOST_CASES:
                raise ValueError(f"too many cases of {text}")
        return found

    def _words(self, node: ast.expr, function: Function | None) -> list[Case]:
        """What a chosen word can be."""
        if isinstance(node, ast.Constant):
            return [[node.value]]
        if (
            isinstance(node, ast.Call)
            and called(node) == "Text"
            and isinstance(node.args[0], ast.Constant)
        ):
            self._inlined.add(id(node))
            return self._cases(node.args[0].value, node.args[1:], function)
        if isinstance(node, ast.IfExp):
            return self._words(node.body, function) + self._words(node.orelse, function)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
            return [*self._words(node.left, function), [""]]
        if isinstance(node, ast.Name) and function is not None and _values(node.id, function):
            return [
                case
                for value in _values(node.id, function)
                for case in self._words(value, function)
            ]
        raise ValueError(
            f"{ast.unparse(node)} is not a choice of words: pass it as a value, without Word"
        )

    def _add(self, case: Case, module: Module, made: bool = False) -> None:
        numbers = count()
        template = "".join(
            f"{{{next(numbers)}}}" if part is None else part.replace("{", "{{").replace("}", "}}")
            for part in case
        ).strip()
        title = str(module.path).endswith(self.titles) and template.isalpha()
        if title or says_something(template, made):
            self.found.setdefault(template, module.path.relative_to(ROOT).as_posix())


def _is_made(call: ast.Call) -> bool:
    """Whether a call makes a Text of a template that is written there."""
    return called(call) == "Text" and call.args != [] and isinstance(call.args[0], ast.Constant)


@cache
def _tellers(tree: ast.AST) -> tuple[ast.Call | ast.Assign, ...]:
    """What may tell something: all calls, and settings of a stage's message."""
    return tuple(
        node
        for node in walked(tree)
        if isinstance(node, ast.Call)
        or (
            isinstance(node, ast.Assign)
            and any(getattr(target, "attr", "") == PROPERTY for target in node.targets)
        )
    )


def _parts(text: str) -> list[Any]:
    """The literal parts of a text with places, and between them the numbers of the values put in."""
    found: list[Any] = []
    given = count()
    for literal, place, _, _ in Formatter().parse(text):
        found += [literal] if literal else []
        found += [] if place is None else [int(place) if place else next(given)]
    return found


def _values(name: str, function: Function) -> list[ast.expr]:
    """What a local variable is given."""
    return _given(function).get(name, [])


@cache
def _given(function: Function) -> dict[str, list[ast.expr]]:
    """What all local variables are given: by statements, then by loops, and by calls that add to a list."""
    found: dict[str, list[ast.expr]] = {}
    for node in walked(function):
        if isinstance(node, ast.stmt):
            for name, value in assigned(node):
                found.setdefault(name, []).append(value)
    for node in walked(function):
        if isinstance(node, (ast.For, ast.comprehension)):
            for name in {one.id for one in ast.walk(node.target) if isinstance(one, ast.Name)}:
                found.setdefault(name, []).append(node.iter)
        elif (
            isinstance(node, ast.Call)
            and node.args
            and called(node) in ("append", "insert", "extend")
        ):
            holder = getattr(node.func, "value", None)
            if isinstance(holder, ast.Name):
                found.setdefault(holder.id, []).append(node.args[-1])
    return found


def _is_list(function: Function, name: str) -> bool:
    """Whether a parameter is a list of texts."""
    note = next(one.annotation for one in function.args.args if one.arg == name)
    return note is not None and ast.unparse(note) == "list[str]"


def says_something(template: str, made: bool = False) -> bool:
    """Whether a text is several words, and not the name of something; of one that is made one word is enough, or a sign
    before which French has a space."""
    literal = re.sub(r"\{\d+\}", " ", template)
    words = _WORD.findall(literal)
    if made:
        rest = re.sub(r"`[^`]*`|\b[a-z_]+(?:\.[a-z_]+)+", " ", literal)  # without what is typed
        return (
            bool(set(_WORD.findall(rest)) - UNITS) or re.search(r"[:;?](?= |$)", rest) is not None
        )
    return len(words) >= 2 and " " in template.strip()
