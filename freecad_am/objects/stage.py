# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common base of stages: parameters as properties, a stored result with the key of its inputs, a
status.

A stage is computed by `renew`, which raises the errors of the core; FreeCAD's recompute goes through `execute`, which
turns them into the status, a message and one line on the console. Results are read back when first asked for.

Computing has two steps: `prepare` reads the document, and the work that it returns does not touch it. So the work can be
done in another thread while the window stays alive, and be dropped at any moment.
"""

from __future__ import annotations

import contextlib
import importlib
import time
from collections.abc import Iterator
from contextvars import ContextVar
from typing import Any, ClassVar

import FreeCAD as App

from ..core.issues import ERROR, AmError, InfeasibleError, InputError, Issue, Text, Word, has_errors
from ..core.one_thread import one_thread
from . import staleness
from .fields import properties, rows
from .fields.properties import HIDDEN, OUTPUT, READ_ONLY
from .results import fingerprints, store
from .results.findings import first_message, issues_of, reason_of, say, store_issues
from .results.fingerprints import SCHEMA_VERSION
from .results.store import Stored
from .shapes.containers import broken_link, is_there
from .shapes.file_links import missing_files
from .stage_parts import Link, Outcome, Section, Work
from .staleness import FAILED, INFEASIBLE, STALE, STATUSES, UP_TO_DATE
from .work import faults, hooks, progress

CLASS_PROPERTY = "StageClass"
_RESULT = "Result"
_is_deferred: ContextVar[bool] = ContextVar("is_deferred", default=False)


class Stage(Stored):
    """Base of the proxies. Class paths are a file format; nothing is kept in the proxy that must be saved."""

    kind: ClassVar[str] = ""
    sections: ClassVar[tuple[Section, ...]] = ()
    links: ClassVar[tuple[Link, ...]] = ()
    figures: ClassVar[tuple[tuple[str, str, str], ...]] = ()  # property, FreeCAD type, help
    _busy = False
    changes = 0  # of the inputs, counted by `staleness`
    was_run = False  # by FreeCAD in its last recompute

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        self.complete(obj)
        hooks.attach(obj)

    # ---- what a stage defines

    def prepare(self, obj: Any) -> Work:
        """Read the inputs and return the work that makes the result without the document. Both
        raise InputError and InfeasibleError.
        """
        raise NotImplementedError

    def further_inputs(self, obj: Any) -> list[str]:
        """Fingerprints of inputs that are neither parameters nor linked stages."""
        return []

    # ---- properties

    def complete(self, obj: Any) -> None:
        """Add the properties the object lacks, which is also the migration of an old document."""
        staleness.watch()
        have = set(obj.PropertiesList)

        def add(type_name: str, name: str, group: str, help: str, attributes: int = 0) -> bool:
            if name not in have:
                obj.addProperty(type_name, name, group, help, attributes)
            return name not in have

        for link in self.links:
            # parts and bodies may be nested in assemblies: links to them reach into those
            add(
                link.type_name if link.kind else f"{link.type_name}Global",
                link.name,
                "Inputs",
                link.help,
            )
        for section in self.sections:
            properties.add(obj, section.cls, section.group)
        if add(
            "App::PropertyEnumeration",
            "Status",
            _RESULT,
            "Whether the result matches its inputs.",
            READ_ONLY | OUTPUT,
        ):
            obj.Status = list(STATUSES)
            obj.Status = STALE
        add(
            "App::PropertyString",
            "Message",
            _RESULT,
            "The problem and its remedy.",
            READ_ONLY | OUTPUT,
        )
        for name, type_name, help in self.figures:
            add(type_name, name, _RESULT, help, READ_ONLY | OUTPUT)
        hidden = HIDDEN | OUTPUT
        add("App::PropertyString", "Issues", _RESULT, "Findings, as JSON.", hidden)
        add(
            "App::PropertyString",
            "Texts",
            _RESULT,
            "Template and values of message and findings, as JSON.",
            hidden,
        )
        add(
            "App::PropertyString",
            "Key",
            _RESULT,
            "Fingerprint of the inputs the result was made from.",
            hidden,
        )
        add("App::PropertyFloat", "Seconds", _RESULT, "Computing time.", hidden)
        add("App::PropertyFloatList", "ResultData", _RESULT, "Arrays of the result.", hidden)
        add("App::PropertyString", "ResultLayout", _RESULT, "Contents of the arrays.", hidden)
        if add(
            "App::PropertyString",
            CLASS_PROPERTY,
            _RESULT,
            "Type of the object, in case its proxy is lost.",
            hidden,
        ):
            setattr(obj, CLASS_PROPERTY, f"{type(self).__module__}.{type(self).__name__}")
        if add(
            "App::PropertyInteger", "SchemaVersion", _RESULT, "Version of the properties.", hidden
        ):
            obj.SchemaVersion = SCHEMA_VERSION

    def parameters(self, obj: Any, cls: type) -> Any:
        """The parameters of a dataclass or a subclass; raises InputError naming Label and property."""
        section = next(section for section in self.sections if issubclass(section.cls, cls))
        return properties.read(obj, section.cls, section.prefix)

    # ---- computing

    def renew(self, obj: Any, force: bool = False) -> Any:
        """Compute and store if an input differs from the stored result's (or if forced); return the
        value.

        Raises AmError; the object then says so and keeps its last result. Raises Cancelled, and keeps it too, when the
        user cancels, or when the object is gone by the time it is computed.
        """
        if hooks.carrying():
            raise InputError(
                "BUSY",
                obj.Label,
                "another computation is running; wait until it ends, or cancel it",
            )
        try:
            with one_thread(), faults.kernel(obj):
                key = self.key(obj)
                refused = obj.Status != INFEASIBLE and has_errors(
                    issues_of(obj)
                )  # the messages belong to other inputs
                outdated = (force or refused or key != obj.Key) and self._compute(obj, key)
            issues_found = issues_of(obj)
            with self._own_changes():
                if outdated:
                    say(obj, STALE, "an input changed while it was computed; recompute")
                else:
                    say(
                        obj,
                        INFEASIBLE if has_errors(issues_found) else UP_TO_DATE,
                        first_message(issues_found),
                    )
        except progress.Cancelled:
            if is_there(obj) and key != obj.Key:
                with self._own_changes():
                    say(obj, STALE, "cancelled; recompute")
            raise
        except InfeasibleError as error:
            with self._own_changes():
                store_issues(obj, error.issues or (Issue(ERROR, error.code, error.message),))
                say(obj, INFEASIBLE, error.sentence)
            raise
        except BaseException as error:
            with self._own_changes():
                say(
                    obj,
                    FAILED,
                    error.sentence
                    if isinstance(error, AmError)
                    else f"{type(error).__name__}: {error}",
                )
            raise
        return self.value(obj)

    def _compute(self, obj: Any, key: str) -> bool:
        """Compute and store; return whether the inputs have changed meanwhile."""
        started, changes, label = time.perf_counter(), self.changes, obj.Label
        work = self.prepare(obj)

        def packed() -> tuple[Outcome, list[float], str]:
            with faults.memory(label):
                outcome = work()
                return outcome, *store.pack(outcome.value, key)

        try:
            packed_result = hooks.carry_out(packed, obj.Label)
        except AmError:
            if is_there(obj):
                raise
            raise progress.Cancelled from None
        if not is_there(obj):
            raise progress.Cancelled
        with self._own_changes():
            self._store(obj, *packed_result, key, time.perf_counter() - started)
        return self.changes != changes

    @contextlib.contextmanager
    def _own_changes(self) -> Iterator[None]:
        """Within it changes of the object are its own, and make nothing stale."""
        self._busy = True
        try:
            yield
        finally:
            self._busy = False

    def key(self, obj: Any) -> str:
        """Fingerprint of the inputs. Raises InputError for a missing or failed one."""
        return fingerprints.key_of_inputs(self, obj, fingerprints.key_of_stage)

    def linked(self, obj: Any) -> dict[str, Any]:
        """The linked stages by property name (lists for links to many), checked for the right kind
        and a result.
        """
        if missing := self.missing(obj):
            raise InputError("NO_INPUT", obj.Label, missing)
        return {link.name: checked(obj, link) for link in self.links if link.kind}

    def missing(self, obj: Any) -> str:
        """A remedy for a missing required input, '' if none is missing."""
        for link in self.links:
            if link.required and not getattr(obj, link.name):
                return Text("{} is missing; choose {}", link.name, link.help_phrase)
            if broken := broken_link(getattr(obj, link.name)):
                return _lost_link(obj, broken, link.name)
        return rows.broken(obj)

    def _store(
        self, obj: Any, outcome: Outcome, floats: list[float], text: str, key: str, seconds: float
    ) -> None:
        obj.ResultData, obj.ResultLayout, obj.Seconds = floats, text, seconds
        store_issues(obj, outcome.issues)
        for name, figure in outcome.figures:
            setattr(obj, name, figure)
        self._kept = (key, outcome.value)
        obj.Key = key  # last: views draw when it changes

    def say_failed(self, obj: Any, error: AmError) -> None:
        """Report why it will fail, before its inputs are computed."""
        with self._own_changes():
            say(obj, FAILED, error.sentence)

    # ---- called by FreeCAD

    def execute(self, obj: Any) -> None:
        """Renew, and report errors in the status and in one line on the console. Stages after a
        cancelled one wait for it.
        """
        self.was_run = True
        if _is_deferred.get():
            return
        stale = next(
            (linked.Label for linked in self._linked_stages(obj) if linked.Status == STALE), ""
        )
        if stale:
            with self._own_changes():
                say(obj, STALE, Text("waits for {}; recompute", stale))
            return
        try:
            self.renew(obj)
        except AmError as error:
            App.Console.PrintError(error.line() + "\n")
        except progress.Cancelled:
            if is_there(obj):
                App.Console.PrintWarning(f"{obj.Label}: cancelled\n")

    def _linked_stages(self, obj: Any) -> list[Any]:
        linked = [
            (getattr(obj, link.name) if link.many else [getattr(obj, link.name)])
            for link in self.links
            if link.kind
        ]
        return [entry for entries in linked for entry in entries if stage_of(entry) is not None]

    def mustExecute(self, obj: Any) -> bool:
        """A stale stage is due at the next recompute, whatever made it stale; a failed one is tried again."""
        return obj.Status in (STALE, FAILED)

    def onChanged(self, obj: Any, name: str) -> None:
        """Mark dependent stages as stale at once."""
        if not self._busy and "Status" in obj.PropertiesList and name not in staleness.RESULTS:
            staleness.changed(obj, name)

    def onDocumentRestored(self, obj: Any) -> None:
        """Migrate an old document, show a document that was made without a window, and report what
        a copy lacks.
        """
        with self._own_changes():
            self.complete(obj)
            if missing := self.missing(obj):
                say(obj, FAILED, missing)
        hooks.attach(obj)

    def dumps(self) -> None:
        """Nothing: all is in properties."""

    def loads(self, state: Any) -> None:
        """Nothing to restore."""

    # FreeCAD up to 0.21.1 calls this pair, later ones the other
    __getstate__ = dumps
    __setstate__ = loads


@contextlib.contextmanager
def deferred() -> Iterator[None]:
    """Within it a recompute renews shapes and expressions but no stage; `renew` is then called one by one."""
    token = _is_deferred.set(True)
    try:
        yield
    finally:
        _is_deferred.reset(token)


def _lost_link(obj: Any, label: str, link: str) -> Text:
    """What to do about an input that is a FreeCAD link which shows nothing; it names the missing file, if that is why."""
    missing = missing_files(obj.Document)
    for linked in obj.Document.getObjectsByLabel(label):
        if linked.Name in missing:
            return Text(
                "{} links to {}, which does not exist; restore the file and open the document "
                "again, or choose another {}",
                label,
                missing[linked.Name],
                link,
            )
    return Text(
        "{} links to nothing, as its target was deleted or is not loaded; choose another {}",
        label,
        link,
    )


def stage_of(obj: Any) -> Stage | None:
    """Return the proxy of one of our objects, None for any other object."""
    proxy = getattr(obj, "Proxy", None)
    return proxy if isinstance(proxy, Stage) else None


def checked(obj: Any, link: Link) -> Any:
    """The linked stage, or a list for a link to many, checked for the right kind and a result; None
    without one. Raises InputError BAD_INPUT, INPUT_FAILED; raises InfeasibleError INPUT_INFEASIBLE.
    """
    linked = getattr(obj, link.name)
    return (
        [_checked(obj, link, entry) for entry in linked]
        if link.many
        else _checked(obj, link, linked)
    )


def _checked(obj: Any, link: Link, linked: Any) -> Any:
    if linked is None:
        return None
    stage = stage_of(linked)
    if stage is None or stage.kind != link.kind:
        article = "an" if link.kind[0] in "aeiou" else "a"
        raise InputError(
            "BAD_INPUT",
            f"{obj.Label}.{link.name}",
            "{} is not {} {}; choose one",
            linked.Label,
            Word(article),
            link.kind,
        )
    if linked.Status == INFEASIBLE:
        why = Text("{} is infeasible: {}", linked.Label, reason_of(linked))
        raise InfeasibleError("INPUT_INFEASIBLE", obj.Label, why, issues=issues_of(linked))
    if linked.Status == FAILED or not linked.Key:
        raise InputError(
            "INPUT_FAILED",
            obj.Label,
            "waits for {}: {}",
            linked.Label,
            reason_of(linked) or "recompute it",
        )
    return linked


# ---- Gives objects their proxies back that were saved by a FreeCAD in which the workbench was
# not installed
#
# FreeCAD imports proxies of installed addons only and saves an object without its proxy when it
# could not. All else is in properties, the class of the proxy included.

_PACKAGE_PREFIX = __name__.rpartition(".")[0] + "."


def revive(document: Any) -> None:
    """Restore the proxies that the document lost."""
    for obj in document.Objects:
        if stage_of(obj) is None and CLASS_PROPERTY in obj.PropertiesList:
            cls = _stage_class(getattr(obj, CLASS_PROPERTY))
            if cls is not None:
                cls(obj)


def _stage_class(path: str) -> type[Stage] | None:
    """The stage of a class path, None unless it is one of ours."""
    module, _, name = path.rpartition(".")
    if not module.startswith(_PACKAGE_PREFIX):
        return None
    try:
        candidate = getattr(importlib.import_module(module), name, None)
    except ImportError:
        return None
    return candidate if isinstance(candidate, type) and issubclass(candidate, Stage) else None
