"""Results as pages for a browser, and prefixes of results."""

import os
import tempfile

from . import _checks
from ._core import InputError, report_page, write_page

_ENDINGS = (".residues.csv", ".json", ".vtp", ".h5", ".csv")


def written(page, path):
    """The page's text without a path, otherwise the path of the file."""
    if path is None:
        return page
    path = _checks.path("path", path)
    write_page(path, page)
    return path


def table_beside(prefix):
    """The text of OUT.csv; None without such a file."""
    if not os.path.exists(prefix + ".csv"):
        return None
    with open(prefix + ".csv", encoding="utf-8") as file:
        return file.read()


def page_of_files(files, name, path, title):
    """The page of a result whose files are these bytes or texts, by their endings."""
    _checks.text("title", title)
    with tempfile.TemporaryDirectory(prefix="espdiff-") as folder:
        prefix = os.path.join(folder, name)
        for ending, content in files.items():
            with open(prefix + ending, "wb") as file:
                file.write(content if isinstance(content, bytes) else content.encode())
        page = report_page(prefix, title)
    return written(page, path)


def report(result, path=None, *, title: str = "", range_of=()):
    """One page for any browser, without network, of the files of a pair, trajectory, matrix or ensemble.

    result: its prefix OUT, or one of its files. range_of: other results, of surfaces: the widest range of all is taken.
    Writes the page to `path` and returns that; returns the page's text without one.
    Raises IoError, FormatError, InputError.
    """
    _checks.text("title", title)

    def prefix_of(name, given):
        given = _checks.path(name, given)
        return next((given[:-len(end)] for end in _ENDINGS if given.endswith(end)), given)

    if isinstance(result, (dict, list)) or not isinstance(result, (str, os.PathLike)):
        raise InputError(f"result: a {type(result).__name__} is no path of a result; a Comparison, Matrix or Ensemble has .report()")
    others = [prefix_of("range_of", other) + ".vtp" for other in _checks.several("range_of", range_of, "results")]
    return written(report_page(prefix_of("result", result), title, others), path)
