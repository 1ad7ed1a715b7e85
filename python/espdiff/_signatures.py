"""Signatures of the functions that take the comparison's options, from the table of options.

help(), completion and inspect.signature() show every option with type and default; type checkers read the same from
_options.py, which `python -m espdiff._signatures` writes.
"""

import difflib
import functools
import inspect
import os
import typing

from . import _checks, _core

_TYPES = {"number": float, "integer": int, "boolean": bool, "choice": str, "text": str, "list": typing.Union[str, list],
          "named": dict}
PLURALS = {"patch": "patches", "field": "fields"}  # of options that may be given several times, under names
PREPARATION_GROUPS = ("Structures", "Charges")
# Options of these functions whose name on the command line is a word of Python's, or whose two words are a switch.
STUDY_NAMES = {"from": "from_file", "on-error": "skip_errors"}


def option_rows(groups=None):
    """The rows of the table under their Python names: grid_spacing for grid-spacing, patches for several of patch, fields of field."""
    rows = []
    for row in _core.settings():
        if groups is None or row["group"] in groups:
            name = PLURALS[row["name"]] if row["kind"] == "named" else row["name"].replace("-", "_")
            rows.append({**row, "name": name})
    return rows


def _default(row):
    text = row["default"]
    if text == "" or row["kind"] in ("list", "named"):
        return text or None
    return {"number": float, "integer": int, "boolean": lambda t: t == "1"}.get(row["kind"], str)(text)


def study_rows(study):
    """The rows of the options that "matrix", "trajectory" or "ensemble" has besides those of compare(), under their Python names."""
    rows = []
    for row in _core.study_settings(study):
        if row["name"] == "on-error":
            row = {**row, "kind": "boolean", "default": "0"}
        rows.append({**row, "option": row["name"], "name": STUDY_NAMES.get(row["name"], row["name"].replace("-", "_"))})
    return rows


def study_defaults(study):
    """{name: default} of these."""
    return {row["name"]: None if row["name"] == "shard" else _default(row) for row in study_rows(study)}


def study_texts(study, given):
    """[(option, text)] of those that are given, by Python's names."""
    texts = []
    for row in study_rows(study):
        name, value = row["name"], given.get(row["name"])
        if value is None:
            continue
        if row["kind"] == "boolean":
            value = _checks.switch(name, value)
            value = ("skip" if value else "stop") if row["option"] == "on-error" else str(int(value))
        elif row["kind"] == "text":
            value = os.fspath(value) if isinstance(value, os.PathLike) else str(value)
        texts.append((row["option"], as_text(value)))
    return texts


def as_text(value):
    """An option's value as the tables read it."""
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, (list, tuple)):
        return ",".join(as_text(entry) for entry in value)
    return repr(float(value)) if isinstance(value, float) else str(value)  # NumPy's numbers have a repr of their own


def takes_options(function=None, *, groups=None, besides=(), without=()):
    """Shows the options that **options stands for, and refuses others.

    groups: of the table's; all without it. besides: names of keyword arguments that the function handles itself.
    without: names of the table's that it does not take.
    """
    if function is None:
        return functools.partial(takes_options, groups=groups, besides=besides, without=without)
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    taken = {p.name for p in own} | set(without)
    rows = [row for row in option_rows(groups) if row["name"] not in taken]
    extra = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value) for name, value in dict(besides).items()
             if name not in taken]
    options = [inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY, default=_default(row),
                                 annotation=_TYPES[row["kind"]]) for row in rows]
    accepts = {row["name"]: row["accepts"] for row in rows if row["kind"] in ("number", "integer")}
    known = (taken - set(without)) | {p.name for p in extra} | {row["name"] for row in rows} | set(PLURALS)
    label = function.__qualname__.replace(".__init__", "")

    @functools.wraps(function)
    def checked(*arguments, **named):
        for name, value in named.items():
            if name in without:
                raise _core.InputError(f"{label}: there is no option {name}")
            if isinstance(value, bool) and name in accepts:
                raise _core.InputError(f"{name}: {value} is not {accepts[name]}")
            near = difflib.get_close_matches(name, known, 1) if name not in known else []
            if near:
                raise _core.InputError(f"{label}: there is no option {name}; did you mean {near[0]}?")
        if "progress" in taken:
            _checks.listener(named.get("progress"))
        return function(*arguments, **named)

    checked.__signature__ = signature.replace(parameters=own + extra + options)
    return checked


def _typed_class(head, doc, rows):
    names = {"number": "float", "integer": "int", "boolean": "bool", "choice": "str", "text": "str",
             "list": "Union[str, List[str]]", "named": "Dict[str, str]"}
    lines = ["", "", f"class {head}:", f'    """{doc}"""', ""]
    for row in rows:
        kind = row["kind"]
        if kind == "choice":
            lines.append("    # " + ", ".join(row["choices"]))
        # Of a field, a kind's name or an array.
        lines.append(f"    {row['name']}: {'Dict[str, Any]' if row['name'] == 'fields' else names[kind]}")
    return lines


def typed_options():
    """The content of _options.py."""
    lines = ['"""The options of comparisons for type checkers; written by `python -m espdiff._signatures`."""', "",
             "from typing import Any, Dict, List, TypedDict, Union"]
    lines += _typed_class("Options(TypedDict, total=False)",
                          "What **options of compare() and its like stands for; `espdiff.help_options()` explains them.",
                          option_rows())
    groups = [{"name": name, "kind": "named"} for name in ("charges", "maps")]
    for study, besides in (("matrix", []), ("trajectory", []), ("ensemble", groups)):
        lines += _typed_class(f"{study.capitalize()}Options(Options, total=False)", f"The same of {study}().",
                              besides + study_rows(study))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    import pathlib

    pathlib.Path(__file__).with_name("_options.py").write_text(typed_options())
