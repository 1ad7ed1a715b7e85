"""Tables of frames as columns; used inside VMD too, so it needs neither the engine nor NumPy."""

import csv
import math


class Trajectory:
    """The result of trajectory(): its numbers, frames, rows, skipped, resumed, csv, ...; and the file's columns."""

    def __init__(self, summary):
        self.result = summary

    @property
    def columns(self):
        """{name: one value for each row}: numbers, NaN where there is none; texts where a column has some."""
        with open(self.result["csv"], newline="", encoding="utf-8") as lines:
            rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        return {name: column([row[name] for row in rows]) for name in (rows[0] if rows else ()) if name != "checksum"}

    def to_frame(self):
        """The columns as a pandas.DataFrame."""
        from ._results import frame_of

        return frame_of(self.columns)

    def __repr__(self):
        return "<espdiff trajectory of %d rows in %s>" % (self.result["rows"] + self.result["resumed"], self.result["csv"])


def number(text):
    return float(text) if text != "" else math.nan


def column(texts):
    try:
        values = [number(text) for text in texts]
    except ValueError:
        return texts
    try:
        import numpy
    except ImportError:
        return values
    return numpy.array(values)
