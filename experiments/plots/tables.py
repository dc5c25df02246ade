"""Tables of the report: columns with a meaning, cells with a text and a value to sort by."""

import pandas as pd

from .verdict import has_value, percent

# (column, class in report.css, what it says): of the rays whose true point the frame shows.
SPLIT = [("recall_1px", "found", "found within 1 px"), ("visible_displaced", "displaced", "hit farther away"),
         ("missed_not_in_depth", "not-in-depth", "not in the depth buffer"), ("missed_stepped_over", "skipped-over", "stepped over"),
         ("missed_out_of_steps", "out-of-steps", "out of steps"), ("missed_stopped", "stopped", "stopped"),
         ("missed_facing_rule", "facing", "refused by the facing rule")]
SHOWN = [("cost_ms_median", "ms", "trace and structures, median"), ("cost_ms_ci_low", "from", "95 % confidence interval"), ("cost_ms_ci_high", "to", "95 % confidence interval"),
         ("fetches_mean", "fetches", "per ray"), ("steps_mean", "steps", "per ray"), ("recall_1px", "recall", "found within 1 px, of what the frame shows"),
         ("precision_1px", "precision", "hits that are right"), ("f1_1px", "F1", "of recall and precision"),
         ("false_hits", "false", "false hits, of all rays"), ("screen_recall_1px", "screen recall", "found within 1 px, of what the depth buffer holds"),
         ("screen_precision_1px", "screen precision", "hits that are the screen truth's"), ("flip_visible", "FLIP", "over visible rays"),
         ("picture_flip", "picture FLIP", "finished picture against the truth"), ("frame_ms_median", "frame ms", "all passes"), ("fps", "fps", "frames a second"),
         ("all_recall", "all: recall", "rightly answered by the sources, of all rays that meet geometry"),
         ("all_precision", "all: precision", "right ones, of rays that the sources answer by a point"), ("all_f1", "all: F1", "of the two"),
         ("sources_ms", "sources ms", "drawing, tracing and lighting of all sources"), ("repeats", "repeats", "timed frames")]
SHARES = {"recall_1px", "precision_1px", "f1_1px", "false_hits", "screen_recall_1px", "screen_precision_1px", "all_recall", "all_precision", "all_f1"}


def cell(value, text=None, series=""):
    """Sorted by the value; what is not known is empty and stays last."""
    if value is None or (not isinstance(value, str) and pd.isna(value)):
        return {"text": "", "sort": "", "series": series}
    if isinstance(value, (str, bool)):
        return {"text": str(value), "sort": None, "series": series}
    return {"text": text if text is not None else f"{value:.4g}", "sort": f"{value:.8g}", "series": series}


def share(value):
    return cell(value, "" if pd.isna(value) else percent(value))


def column(name, doc=""):
    return {"name": name, "doc": doc}


def table(columns, rows, example="hiz"):
    for i, one in enumerate(columns):
        one["text"] = all(row["cells"][i]["sort"] is None for row in rows)
    return {"columns": columns, "rows": rows, "example": example}


def of_row(row, name):
    value = row[name] if name in row else None
    return share(value) if name in SHARES and has_value(row, name) else cell(value)


def ranking_table(ranked):
    """Columns without any value are left out."""
    if ranked.empty:
        return table([], [])
    wanted = [("recall", "recall", "of what the frame shows"), ("precision", "precision", "hits that are right"), ("f1", "F1", "of recall and precision"),
              ("false_hits", "false", "false hits, of all rays"), ("screen_recall", "screen recall", "of what the depth buffer holds"),
              ("flip", "FLIP", "over visible rays"), ("cost_ms_median", "ms", "trace and structures"), ("cost_ms_ci_low", "from", "95 % confidence interval"),
              ("cost_ms_ci_high", "to", "95 % confidence interval"), ("fetches", "fetches", "per ray")]
    wanted = [one for one in wanted if ranked[one[0]].notna().any()]
    shares = {"recall", "precision", "f1", "false_hits", "screen_recall"}
    aims = ranked.reached.any() or ranked.unreached.any()
    rows = []
    for place, (_, row) in enumerate(ranked.iterrows()):
        cells = [cell(place + 1, str(place + 1)), cell(row.label, series=row.series)]
        cells += [cell(row.reached, f"{row.reached} of {row.of}")] if aims else []
        cells += [share(row[name]) if name in shares else cell(row[name]) for name, _, _ in wanted]
        rows.append({"cells": cells, "best": place == 0 and aims and row.reached > 0})
    reached = [column("target reached", "on how many frames")] if aims else []
    return table([column("rank"), column("tracer")] + reached + [column(name, doc) for _, name, doc in wanted], rows, ranked.technique.iloc[0])


def row_table(results, rows, chosen):
    """Every run of a frame, with what varies."""
    inputs = [name for name in results.swept(rows)]
    shown = [one for one in SHOWN if one[0] in rows and rows[one[0]].notna().any()]
    best = chosen.run_id.iloc[0] if len(chosen) and chosen.reached.iloc[0] else ""
    made = []
    for _, row in rows.sort_values(["series"] + inputs).iterrows():
        cells = [cell(row.series, series=row.series)] + [of_row(row, name) for name in inputs]
        cells += [of_row(row, name) for name, _, _ in shown] + [cell(row.run_id)]
        made.append({"cells": cells, "run": row.run_id, "best": row.run_id == best})
    columns = [column("tracer")] + [column(name, "setting") for name in inputs] + [column(name, doc) for _, name, doc in shown]
    return table(columns + [column("run")], made, rows.technique.iloc[0])


def split_of(chosen):
    """A bar a tracer: what became of the rays whose true point the frame shows."""
    bars = []
    for _, row in chosen.iterrows():
        if not has_value(row, "recall_1px"):
            continue
        parts = [{"kind": kind, "width": round(100 * row[name], 2), "text": percent(row[name]), "title": f"{said}: {percent(row[name])}"}
                 for name, kind, said in SPLIT if has_value(row, name) and row[name] > 0]
        bars.append({"name": row.setting, "series": row.series, "parts": parts, "alt": f"{row.setting}: " + ", ".join(part["title"] for part in parts)})
    return bars


def error_table(chosen):
    """The three errors, and the causes of false hits."""
    wanted = [("error_scene_to_screen", "scene → screen", "what the depth buffer lacks"),
              ("error_screen_to_double", "screen → double", "what the tracer skips"), ("error_double_to_float", "double → float", "rounding"),
              ("false_hits", "false", "false hits, of all rays"), ("false_self", "false: itself", "on the reflector itself"),
              ("false_too_thick", "false: too thick", "a thinner slab would let the ray pass"),
              ("false_wrong_surface", "false: other surface", "a front that the true ray does not meet"),
              ("wrong_rays", "wrong", "wrong rays, of all rays; the next columns are their causes and sum to it"),
              ("wrong_own_surface", "own surface", "the ray starts below its own surface or meets it"),
              ("wrong_not_shown", "not shown", "the frame does not show the true point"),
              ("wrong_thin", "thin", "no pixel around the true point holds it"),
              ("wrong_silhouette", "silhouette", "at a pixel whose neighbour lies far off its plane"),
              ("wrong_edge", "edge", "at a pixel where two planes meet"),
              ("wrong_stopped", "stopped", "stopped in the middle of a plane"), ("wrong_other", "other", "none of these")]
    wanted = [one for one in wanted if one[0] in chosen and chosen[one[0]].notna().any()]
    if not wanted:
        return table([], [])
    rows = [{"cells": [cell(row.setting, series=row.series)] + [share(row[name]) for name, _, _ in wanted], "run": row.run_id}
            for _, row in chosen.iterrows()]
    return table([column("tracer")] + [column(name, doc) for _, name, doc in wanted], rows, chosen.technique.iloc[0])


def plan_of(results, chosen):
    """Passes of the best tracer's frame, those that ran first; with a bandwidth, the least time in which a pass could move its bytes."""
    passes = results.passes[results.passes.run_id == (chosen.run_id.iloc[0] if len(chosen) else "")]
    if passes.empty:
        return None
    timed = results.bandwidth_gbps is not None and "bytes_read_mean" in passes
    pixels = chosen.width.iloc[0] * chosen.height.iloc[0]
    lines = [{"name": row["pass"], "ms": f"{row.ms_median:.3g}" if row.ran else "–", "why": row.reason if has_value(row, "reason") else "",
              "least_ms": f"{(row.bytes_read_mean + row.bytes_written_mean) * pixels / (results.bandwidth_gbps * 1e6):.3g}" if timed and row.ran else "–"}
             for _, row in passes.sort_values("ran", ascending=False, kind="stable").iterrows()]
    return {"of": chosen.setting.iloc[0], "passes": lines, "bandwidth_gbps": results.bandwidth_gbps if timed else None}


def failed_table(results, again):
    failed = results.all_rows[results.all_rows.outcome.isin(["failed", "invalid"])]
    columns = [column(name) for name in ("tracer", "scene", "view", "size", "outcome", "message", "command")]
    rows = [{"cells": [cell(text) for text in (row.technique, row.scene, row["view"], f"{row.width}×{row.height}", row.outcome,
                                               row.message if has_value(row, "message") else "", again(results, row.run_id))]}
            for _, row in failed.iterrows()]
    return table(columns, rows, "timeout")


def plain_table(rows):
    """rows: dictionaries with the same keys; texts that are numbers are sorted as numbers."""
    def sorted_as(value):
        try:
            return cell(float(value), str(value))
        except ValueError:
            return cell(str(value))
    return table([column(name) for name in rows[0]], [{"cells": [sorted_as(value) for value in row.values()]} for row in rows], "interior")
