"""Arguments of the wrong kind, as one InputError that names the argument."""

import os

from ._core import InputError


def text(name, value):
    if not isinstance(value, str):
        raise InputError(f"{name}: {value!r} is not a text")
    return value


def path(name, value):
    if not isinstance(value, (str, os.PathLike)):
        raise InputError(f"{name}: a {type(value).__name__} is not a path")
    return os.fspath(value)


def prefix(name, value):
    """Of files: a name, perhaps in a folder, and not the folder alone."""
    value = path(name, value)
    if not os.path.basename(value):
        raise InputError(f"{name}: {value!r} names no file; give a name, such as {os.path.join(value, 'result')!r}")
    return value


def switch(name, value):
    if value not in (True, False):
        raise InputError(f"{name}: {value!r} is not True or False")
    return bool(value)


def several(name, value, what):
    """A list of something that is not the thing itself."""
    if isinstance(value, (str, bytes, os.PathLike, dict)) or not hasattr(value, "__iter__"):
        raise InputError(f"{name}: a {type(value).__name__} is no list of {what}; give [first, second, ...]")
    return list(value)


def listener(value):
    if value is None or isinstance(value, bool) or callable(value):
        return value
    raise InputError(f"progress: {value!r} is neither True nor a function of (stage, fraction)")
