"""Results as HTML, for notebooks: verdict, table, picture. Texts of files are escaped."""

import html
import os

import numpy as np

from . import _core

_MAIN = ("mean_abs_difference", "mean_difference", "rms_difference", "max_abs_difference", "hodgkin_index",
         "sign_change_area_fraction", "area_A2", "mean_displacement_A", "rmsd_A")
_GOOD, _BAD = "#1a7f37", "#b35900"


def _escaped(value):
    return html.escape(str(value))


def _verdict(words, reasons=()):
    colour = _GOOD if words.startswith("TRUSTWORTHY") else _BAD
    lines = "".join(f"<li>{_escaped(reason)}</li>" for reason in reasons)
    return (f'<p style="margin:4px 0"><strong style="color:{colour}">{_escaped(words)}</strong></p>'
            + (f'<ul style="margin:0 0 6px">{lines}</ul>' if lines else ""))


def _table(rows, heads=()):
    head = "".join(f"<th>{_escaped(cell)}</th>" for cell in heads)
    body = "".join("<tr>" + "".join(f"<td>{_escaped(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table>{f'<thead><tr>{head}</tr></thead>' if head else ''}<tbody>{body}</tbody></table>"


def _number(value):
    return "-" if value is None or not np.isfinite(value) else f"{value:.4g}"


def _metric_rows(result):
    values, about = result.metrics, {row["name"]: row for row in _core.metrics()}
    for name in _MAIN:
        row = about.get(name)
        if row is None or not np.isfinite(values.get(name, np.nan)):
            continue
        unit = result.unit if row["shown_unit"] == "potential" else row["shown_unit"]
        yield row["label"], f"{_number(row['shown_factor'] * values[name])} {unit}".strip()


def certificate(given):
    from ._results import verdict_of

    return _verdict(verdict_of(given.to_dict()), given.reasons)


def _picture(result):
    from . import _picture as picture

    if not result.has_potential:
        return ""
    drawn, limit = picture.of_comparison(result)
    unit = _escaped(result.unit)
    return (f'<div><img alt="potential difference on the surface, from both sides" src="{picture.inline(drawn)}"><br>'
            f'<small>-{limit:g} <img alt="scale" style="display:inline" src="{picture.inline(picture.scale_png())}"> '
            f"+{limit:g} {unit}: target minus source on the source's surface, both sides; grey: not compared</small></div>")


def comparison(result):
    record = result.to_dict()
    names = {entry["role"]: os.path.basename(entry["path"]) for entry in record["inputs"]}
    title = " &rarr; ".join(_escaped(names.get(f"{role}_file", names.get(role, role))) for role in ("source", "target"))
    warnings = "".join(f"<li>{_escaped(text)}</li>" for text in result.warnings)
    more = f"<details><summary>{len(result.warnings)} warnings</summary><ul>{warnings}</ul></details>" if warnings else ""
    return (f"<div><strong>espdiff</strong> {title}{_verdict(result.verdict, record['certificate']['reasons'])}"
            f'<div style="display:flex;gap:16px;flex-wrap:wrap;align-items:flex-start">{_table(_metric_rows(result))}'
            f"{_picture(result)}</div>{more}</div>")


def matrix(result):
    metric = "mean_abs_difference" if "mean_abs_difference" in result.metrics else result.metrics[0]
    values, trusted, labels = result[metric], result.trustworthy, result.labels
    rows = [[label, *(("" if i == j else _number(values[i, j]) + ("" if trusted[i, j] else " *")) for j in range(len(labels)))]
            for i, label in enumerate(labels)]
    off = ~np.eye(len(labels), dtype=bool)
    n_bad = int((~trusted[off]).sum())
    least = np.minimum(result["trusted_source"], result["trusted_target"])[off & trusted]
    on = f" on {100 * np.nanmin(least):.0f} % of their surfaces and more" if least.size and np.nanmin(least) < 0.95 else ""
    words = (f"NOT TRUSTWORTHY: {n_bad} of {off.sum()} pairs, marked *" if n_bad else f"TRUSTWORTHY: all {off.sum()} pairs{on}")
    return (f"<div><strong>espdiff</strong> matrix of {len(labels)} states{_verdict(words)}"
            f"<p>{_escaped(metric)}; row: source, column: target</p>{_table(rows, ['', *labels])}</div>")


def ensemble(result):
    record = result.to_dict()
    conclusion = record.get("conclusion", "")
    lines = conclusion if isinstance(conclusion, list) else [conclusion]
    columns = result.residue_columns()
    shown = [name for name in ("residue", "difference", "low", "high", "p_false_discovery") if name in columns]
    order = np.argsort(np.nan_to_num(np.asarray(columns.get("p", columns[shown[-1]]), float), nan=2.0), kind="stable")[:8]
    rows = [[columns[name][i] if name == "residue" else _number(columns[name][i]) for name in shown] for i in order]
    text = "".join(f"<p>{_escaped(line)}</p>" for line in lines if line)
    return f"<div><strong>espdiff</strong> {_escaped(repr(result)[1:-1])}{text}{_table(rows, shown)}</div>"
