# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measure how plainly the code and its prose are written. The limits equal the current values and
may only go down: a commit that writes plainer text lowers them. The last column of LIMITS is the
aim."""

import ast
import io
import re
import tokenize
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "freecad_am"
GENERIC_NAMES = {
    "found",
    "one",
    "other",
    "others",
    "some",
    "made",
    "mine",
    "which",
    "way",
    "ways",
    "own",
    "given",
    "asked",
    "wanted",
    "more",
    "most",
    "least",
    "left",
    "away",
    "apart",
    "every",
    "each",
    "here",
    "there",
    "shown",
    "looked",
    "known",
    "kept",
    "read",
    "piece",
    "pieces",
    "place",
    "places",
    "part",
    "parts",
    "lost",
    "held",
    "chosen",
    "those",
    "these",
    "both",
    "of",
    "at",
    "meant",
    "seen",
    "taken",
    "tried",
    "done",
    "begun",
    "ended",
    "told",
    "said",
    "fewer",
    "few",
    "many",
    "near",
    "far",
    "before",
    "after",
    "last",
    "first",
    "whole",
    "rest",
    "so",
}
PARTICIPLES = re.compile(
    r"_?(alone|along|apart|around|aside|at|away|begun|beyond|carried|done|drawn|driven|each|ended|every|fed|followed|found|"
    r"given|gone|grown|held|here|joined|judged|kept|laid|lost|made|met|moved|of_\w+|off|on_\w+|own|parted|picked|placed|"
    r"pulled|put_in|reached|run_on|said|seen|served|shown|spread|started|stepped|taken|tell|tidied|told|touched|travelled|"
    r"tried|turned|twice|wanted|whole|with_\w+|without_\w+|where_\w+|why|within|worth|written)"
)
BARE_ADJECTIVES = re.compile(
    r"_?(ALIKE|AMPLE|APART|ASIDE|ASKED|BEYOND|BESIDE|CLOSE|DONE|EACH|ENOUGH|EQUAL|EVERY|FAR|FARTHEST|FEW|FEWEST|FINEST|FIRST|"
    r"FITS|FLAT|FOUND|FREE|FULL|FURTHER|GONE|HARDLY|HELD|HERE|HIGHER|INSIDE|KEPT|LARGE|LARGEST|LAST|LEAST|LEFT|LEVEL|LONG|"
    r"LONGER|LONGEST|LOOKS?|LOST|LOW|MANY|MORE|MOST|MUCH|NARROWEST|NEAR|NEAREST|NEARLY|OFF|ON|ONTO|OPEN|OTHER|OUT|OUTER|OWN|"
    r"QUICK|READY|ROUGH|SAME|SEEN|SHARP|SHORT|SHORTER|SHORTEST|SLACK|SMALL|SMALLEST|STEEP|STRAIGHT|SURE|TIGHT|TOGETHER|TOLD|"
    r"TOO_\w+|TRIED|USUAL|WELCOME|WHOLE|WIDE|WIDER|WIDEST|WITHIN|WORTH|WRONG)"
)
ODD_TURNS = re.compile(
    r"\b(?:tells?|told|telling|laid|beside|anew|look(?:s|ed|ing)? at|so (?:many|far|long|fast|much)|that of|those of|those that|"
    r"that which|of (?:it|them|these|which|what|those|this|that|all)|none where|there (?:is|are) none|where there|not there|"
    r"be there|but for|by (?:itself|themselves)|alone|stands?|lies?|somebody|nobody|whoever|anybody|(?:what|whatever) "
    r"(?:is|was|were|are|it|that|they|has|had|of|else|comes?|stands?|lies|follows|others?|takes?|does|may|can|would|will|only|"
    r"all|belongs|needs|goes))\b|(?:^|[.;:] )Of\b",
    re.IGNORECASE | re.MULTILINE,
)
MESSAGES = {"InputError", "InfeasibleError", "AmError", "Issue", "Text", "Word", "tr", "parameter"}
LIMITS = {  # name: (current limit, aim)
    "generic names, %": (1.0, 2.0),
    "functions named by a participle or preposition, %": (0.5, 1.0),
    "constants that are bare adjectives": (2, 10),
    "tokens a line": (8.0, 8.0),
    "odd turns in 1,000 words of comments": (3.0, 8.0),
    "odd turns in 1,000 words of docstrings": (3.0, 8.0),
    "odd turns in 1,000 words of messages": (1.5, 8.0),
    "odd turns in 1,000 words of docs": (2.0, 8.0),
    "odd turns in 1,000 words of README": (1.7, 8.0),
}


def plain(text):
    """Return a page without its code."""
    return re.sub(r"`[^`]*`", "X", re.sub(r"```.*?```", "", text, flags=re.DOTALL))


def odd_turns(text):
    """Return the number of odd turns of phrase in 1,000 words."""
    return 1000.0 * len(ODD_TURNS.findall(text)) / max(len(re.findall(r"[A-Za-z']+", text)), 1)


class Measured:
    """Collect the names, tokens and texts of the package."""

    def __init__(self):
        self.names, self.functions, self.constants = Counter(), Counter(), []
        self.texts = {"comments": [], "docstrings": [], "messages": []}
        self.tokens = self.lines = 0
        for path in sorted(PACKAGE.rglob("*.py")):
            source = path.read_text(encoding="utf-8")
            self._count_tokens(source)
            tree = ast.parse(source)
            self._count_constants(tree)
            for node in ast.walk(tree):
                self._count(node)

    def _count_tokens(self, source):
        layout = (tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
        for token in tokenize.generate_tokens(io.StringIO(source).readline):
            if token.type == tokenize.COMMENT:
                self.texts["comments"].append(token.string)
            elif token.type not in layout:
                self.tokens += 1
        code = (line.strip() for line in source.splitlines())
        self.lines += sum(1 for line in code if line and not line.startswith("#"))

    def _count_constants(self, tree):
        for node in tree.body:
            if isinstance(node, (ast.Assign, ast.AnnAssign)):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                names = [node.id for node in ast.walk(targets[0]) if isinstance(node, ast.Name)]
                self.constants += filter(BARE_ADJECTIVES.fullmatch, names)

    def _count(self, node):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            self.names[node.id] += 1
        elif isinstance(node, ast.arg):
            self.names[node.arg] += 1
        if isinstance(node, ast.FunctionDef):
            self.functions[node.name] += 1
        if isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.Module)):
            self.texts["docstrings"].append(re.sub(r"`[^`]*`", "X", ast.get_docstring(node) or ""))
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in MESSAGES:
                self.texts["messages"] += [
                    child.value
                    for child in ast.walk(node)
                    if isinstance(child, ast.Constant)
                    and isinstance(child.value, str)
                    and " " in child.value
                ]

    def figures(self):
        """Return the figures under the names in LIMITS."""
        generic = sum(count for name, count in self.names.items() if name in GENERIC_NAMES)
        odd = sum(count for name, count in self.functions.items() if PARTICIPLES.fullmatch(name))
        pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md")]
        texts = {name: "\n".join(passages) for name, passages in self.texts.items()}
        texts["docs"] = "\n".join(map(plain, pages))
        texts["README"] = plain((ROOT / "README.md").read_text(encoding="utf-8"))
        return {
            "generic names, %": 100.0 * generic / self.names.total(),
            "functions named by a participle or preposition, %": 100.0
            * odd
            / self.functions.total(),
            "constants that are bare adjectives": len(self.constants),
            "tokens a line": self.tokens / self.lines,
            **{
                f"odd turns in 1,000 words of {name}": odd_turns(text)
                for name, text in texts.items()
            },
        }


@pytest.fixture(scope="module")
def figures():
    return Measured().figures()


@pytest.mark.parametrize("name", LIMITS)
def test_language_becomes_no_odder(figures, name):
    ceiling, aim = LIMITS[name]
    assert figures[name] <= ceiling, f"{figures[name]:.1f}; the aim is {aim:g}: write plainer"


def test_all_figures_have_a_limit(figures):
    assert figures.keys() == LIMITS.keys()


def test_odd_turns_are_counted():
    assert (
        odd_turns("What is laid beside it stands there. Of all that is told nobody knows.") > 300.0
    )
    assert (
        odd_turns("The post rejects the program and names the line. Lower the travel speed.") == 0.0
    )
