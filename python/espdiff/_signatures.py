"""Signatures of the functions that take the comparison's options, from the table of options.

help(), completion and inspect.signature() show every option with type and default; type checkers read the same from
_options.py, which `python -m espdiff._signatures` writes.
"""

import difflib
import functools
import inspect
import typing

from . import _core

_TYPES = {"number": float, "integer": int, "boolean": bool, "choice": str, "text": str, "list": typing.Union[str, list],
          "named": dict}
PLURALS = {"patch": "patches", "field": "fields"}  # of options that may be given several times, under names
PREPARATION_GROUPS = ("Structures", "Charges")


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


def takes_options(function=None, *, groups=None, besides=()):
    """Shows the options that **options stands for, and refuses others.

    groups: of the table's; all without it. besides: names of keyword arguments that the function handles itself.
    """
    if function is None:
        return functools.partial(takes_options, groups=groups, besides=besides)
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
    taken = {p.name for p in own}
    rows = [row for row in option_rows(groups) if row["name"] not in taken]
    extra = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=value) for name, value in dict(besides).items()
             if name not in taken]
    options = [inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY, default=_default(row),
                                 annotation=_TYPES[row["kind"]]) for row in rows]
    known = taken | {p.name for p in extra} | {row["name"] for row in rows} | set(PLURALS)
    label = function.__qualname__.replace(".__init__", "")

    @functools.wraps(function)
    def checked(*arguments, **named):
        for name in named:
            near = difflib.get_close_matches(name, known, 1) if name not in known else []
            if near:
                raise _core.InputError(f"{label}: there is no option {name}; did you mean {near[0]}?")
        return function(*arguments, **named)

    checked.__signature__ = signature.replace(parameters=own + extra + options)
    return checked


def typed_options():
    """The content of _options.py."""
    names = {"number": "float", "integer": "int", "boolean": "bool", "choice": "str", "text": "str",
             "list": "Union[str, List[str]]", "named": "Dict[str, str]"}
    lines = ['"""The options of comparisons for type checkers; written by `python -m espdiff._signatures`."""', "",
             "from typing import Any, Dict, List, TypedDict, Union", "", "", "class Options(TypedDict, total=False):"]
    lines.append('    """What **options of compare() and its like stands for; `espdiff.help_options()` explains them."""')
    lines.append("")
    for row in option_rows():
        kind = row["kind"]
        if kind == "choice":
            lines.append("    # " + ", ".join(row["choices"]))
        # Of a field, a kind's name or an array.
        lines.append(f"    {row['name']}: {'Dict[str, Any]' if row['name'] == 'fields' else names[kind]}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    import pathlib

    pathlib.Path(__file__).with_name("_options.py").write_text(typed_options())
