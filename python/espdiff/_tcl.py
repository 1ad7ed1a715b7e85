"""Tcl's words and lists, and commands of the Tcl package called with Python's values."""

import os

from ._errors import BY_CLASS, Error, InputError

_PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.,:/+-=@%")


def _escaped(character):
    if character in _PLAIN or ord(character) > 127:
        return character
    return "\\u%04x" % ord(character)


def word(value):
    """One word of a Tcl list: of a text, path, number, bool, list or dict (which become lists)."""
    if isinstance(value, bool):
        text = "1" if value else "0"
    elif isinstance(value, (list, tuple)):
        text = " ".join(word(entry) for entry in value)
    elif isinstance(value, dict):
        text = " ".join(word(entry) for pair in value.items() for entry in pair)
    elif isinstance(value, float):
        text = repr(float(value))
    elif isinstance(value, (str, os.PathLike)):
        text = os.fspath(value)
    else:
        text = str(value)
    if "\0" in text:
        raise InputError("%r: a text for Tcl has no zero characters" % text)
    return "".join(_escaped(character) for character in text) if text else "{}"


def _end_of_braces(text, begin):
    depth, at = 0, begin
    while at < len(text):
        if text[at] == "\\":
            at += 1
        elif text[at] == "{":
            depth += 1
        elif text[at] == "}":
            depth -= 1
            if depth == 0:
                return at
        at += 1
    raise InputError("Tcl's list has an open brace: %.60r" % text[begin:])


_LETTERS = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "a": "\a", "b": "\b"}


def _unescaped(text):
    """A word without braces, whose backslashes are Tcl's."""
    if "\\" not in text:
        return text
    made, at = [], 0
    while at < len(text):
        if text[at] != "\\" or at + 1 == len(text):
            made.append(text[at])
            at += 1
            continue
        letter = text[at + 1]
        at += 2
        if letter == "u":
            end = at
            while end < len(text) and end < at + 4 and text[end] in "0123456789abcdefABCDEF":
                end += 1
            made.append(chr(int(text[at:end], 16)) if end > at else "u")
            at = end
        else:
            made.append(_LETTERS.get(letter, letter))
    return "".join(made)


def split_list(text):
    """The words of a Tcl list."""
    words, at = [], 0
    while True:
        while at < len(text) and text[at] in " \t\n\r\f\v":
            at += 1
        if at == len(text):
            return words
        if text[at] == "{":
            end = _end_of_braces(text, at)
            words.append(text[at + 1:end])
            at = end + 1
            continue
        quoted = text[at] == '"'
        at += quoted
        begin = at
        while at < len(text) and (text[at] != '"' if quoted else text[at] not in " \t\n\r\f\v"):
            at += 2 if text[at] == "\\" else 1
        words.append(_unescaped(text[begin:at]))
        at += quoted


def split_dict(text):
    words = split_list(text)
    return dict(zip(words[::2], words[1::2]))


# Leaves nothing in the interpreter's global namespace.
_CATCH = ("apply {{script} { set status [catch {uplevel #0 $script} result options]; "
          "list $status $result [expr {[dict exists $options -errorcode] ? [dict get $options -errorcode] : {}}] }} %s")


class Interpreter:
    """A Tcl interpreter that is reached by a function of a script, as VMD's `evaltcl` is."""

    def __init__(self, evaluate):
        self._evaluate = evaluate

    def eval(self, script):
        """The result of a script. Raises the exception of its errorcode; espdiff.Error for errors of other code."""
        status, result, code = split_list(self._evaluate(_CATCH % word(script)))
        if status in ("0", "2"):
            return result
        code = split_list(code)
        known = len(code) > 1 and code[0] == "ESPDIFF"
        raise (BY_CLASS.get(code[1], Error) if known else Error)(result)

    def call(self, *words):
        """Calls a command with Python's values."""
        return self.eval(" ".join(word(entry) for entry in words))

