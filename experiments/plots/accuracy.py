"""What the next bit of accuracy costs: the curves, their Pareto fronts, and the rows of summary.csv."""
import numpy as np
import pandas as pd

from .data import ALIKE, OVERLAPPING, UNKNOWN, describe, errors, known, listed, order_of
from .pairs import Ratio, paired_ratio
from .paper import height_beside, log_axis, name_lines, sheet, short_names, titled
from .surfaces import place_of

FEWEST_RUNS = 5  # of a frame, for a curve
NOT_REACHED = "not reached"
SUBJECT = "hiz"  # whose speed-ups are the headline; techniques whose names begin with it are its variants, not rivals
# (prefix of the columns, what they are measured against)
TRUTHS = [("", "scene truth"), ("screen_", "screen truth")]
DASHES = ["-", "--", "-.", (0, (6, 1, 1, 1, 1, 1))]  # of surface models; dotted is no error


def pareto(rows, cost, error):
    """Rows that no other row beats in both; cheapest first."""
    front, best = [], np.inf
    for index, row in rows.sort_values([cost, error]).iterrows():
        if row[error] < best:
            front.append(index)
            best = row[error]
    return rows.loc[front]


def draw_intervals(axis, line, cost, error, style):
    """The 95 % confidence interval of each time on its point; hollow where it is not known."""
    name = cost.removesuffix("_median")
    sure = known(line, name)
    axis.errorbar(line[cost][sure], line[error][sure], xerr=errors(line[sure], name), fmt="none", ecolor=style["color"], elinewidth=0.7)
    axis.plot(line[cost][~sure], line[error][~sure], **{**style, "linestyle": "none", "markerfacecolor": "white"})


def lines_of(rows):
    """The line of each row: its technique, with the surface model where it has several; its series where there is one technique."""
    if rows.technique.nunique() == 1:
        return rows.series
    several = rows.groupby("technique").surface.transform("nunique") > 1 if "surface" in rows else False
    return rows.technique.where(~several, rows.technique + ", " + rows.surface) if np.any(several) else rows.technique


def dashes_of(rows):
    """{surface: dash}, the same for all techniques."""
    surfaces = sorted(rows.surface.unique(), key=place_of) if "surface" in rows else []
    return {surface: DASHES[i % len(DASHES)] for i, surface in enumerate(surfaces)}


def draw_fronts(axis, results, rows, column, cost):
    """A line a technique and surface model: its Pareto front. Its other settings are pale points, and a dotted line is no error, or less than can be drawn."""
    floor, ends = 0.5 / max(1.0, rows.rays.max()), []
    rows = rows[rows[column].notna()]
    rows = rows.assign(error=(1 - rows[column]).clip(lower=floor), line=lines_of(rows))
    short, dashes = short_names(rows.line.unique()), dashes_of(rows)
    for name, part in rows.groupby("line"):
        dash = dashes[part.surface.iloc[0]] if "surface" in part and part.surface.nunique() == 1 else "-"
        style, front = dict(results.styles[part.series.min()], linestyle=dash, alpha=1), pareto(part, cost, "error")
        axis.plot(part[cost], part.error, **{**style, "linestyle": "none", "alpha": 0.2, "markersize": 2})
        axis.plot(front[cost], front.error, label=name, **style)
        if cost.endswith("_median"):
            draw_intervals(axis, front, cost, "error", style)
        ends.append((short[name], front[cost].iloc[-1], front.error.iloc[-1], style["color"]))
    if (rows.error <= floor).any():
        axis.axhline(floor, color="#999999", lw=0.6, ls=":")
    log_axis(axis.xaxis)
    log_axis(axis.yaxis)
    name_lines(axis, ends)


def soonest(rows, column, what):
    """The message: which technique is the first to reach 99 %, or the highest step of 5 % that any reaches, and how long the next takes."""
    rows, by = rows.assign(line=lines_of(rows)), "line"
    best = rows[column].max()
    level = 0.99 if best >= 0.99 else np.floor(20 * best) / 20
    reached = rows[rows[column] >= level].sort_values("cost_ms_median").drop_duplicates(by)
    short = short_names(rows[by].unique())
    first, orders = reached.iloc[0], [order_of(reached.iloc[0], row) for _, row in reached.iloc[1:].iterrows()]
    alike = [name for name, order in zip(reached[by].iloc[1:], orders) if order == OVERLAPPING]
    if alike:
        return f"{listed([short[name] for name in (first[by], *alike)])} reach {100 * level:.0f} % {what} in times that {ALIKE}"
    text = f"{short[first[by]]} is the first to reach {100 * level:.0f} % {what}, in {first.cost_ms_median:.3g} ms"
    if not orders:
        return text + ("; no other does" if rows[by].nunique() > 1 else "")
    text += f"; {short[reached[by].iloc[1]]} takes {reached.cost_ms_median.iloc[1] / first.cost_ms_median:.3g} times as long"
    return text + ("; not all intervals are known" if UNKNOWN in orders else "")


def accuracy_curves(results, _):
    """Error against time, with its intervals, and against fetches; precision and F1 against time: recall alone misleads. Log-log."""
    cost, fetches = ("cost_ms_median", "trace + structures, ms"), ("fetches_mean", "fetches per ray")
    note = "lines: Pareto fronts; bars: 95 % CI, hollow: not known; dotted: no error"
    for title, name, rows in results.pictures():
        if len(rows) < FEWEST_RUNS or not results.swept(rows):
            continue
        for prefix, truth in TRUTHS:
            recall, precision, f1 = (f"{prefix}{one}_1px" for one in ("recall", "precision", "f1"))
            for file, message, panels in (
                    (recall, (recall, "recall"), ((recall, "recall", *cost), (recall, "recall", *fetches))),
                    (f"{prefix}precision_f1", (f1, "F1"), ((precision, "precision", *cost), (f1, "F1", *cost)))):
                if any(column not in rows or rows[column].notna().sum() < FEWEST_RUNS for column, *_ in panels):
                    continue
                height = height_beside(short_names(lines_of(rows).unique()).values(), 1.9)
                figure, axes = sheet(height, height)
                for (axis,), (column, said, along, xlabel) in zip(axes, panels):
                    axis.set(xlabel=xlabel, ylabel=f"1 − {said}")
                    draw_fronts(axis, results, rows, column, along)
                titled(figure, soonest(rows, *message), f"{title}; against the {truth}; {note}")
                yield f"accuracy_{file}_{name}", figure


def reaches(rows, measure, target):
    return rows[measure] <= target if measure.startswith("flip") else rows[measure] >= target


def neighbour(results, one, rows, measure, target):
    """The row on the same line (nothing differs but an accuracy parameter) that is the next less accurate one, and misses the
    target; None where the line begins with `one`. And whether the row's technique has such a line at all."""
    has_line = False
    for parameter, better in results.accuracy.get(one.technique, {}).items():
        same = [name for name in results.inputs if name != parameter and rows[name].notna().any()]
        line = rows[rows.technique == one.technique]
        for name in same:
            line = line[(line[name] == one[name]) | (line[name].isna() & pd.isna(one[name]))]
        if line[parameter].nunique() < 2:
            continue
        has_line = True
        worse = line[line[parameter] < one[parameter]] if better == "higher" else line[line[parameter] > one[parameter]]
        worse = worse[~reaches(worse, measure, target)].sort_values(parameter, ascending=better == "higher")
        if len(worse):
            return worse.iloc[-1], True
    return None, has_line


def ratio_of_rows(results, slow, fast):
    """By pairs; without samples the ratio of the medians, and no interval."""
    slow_ms, fast_ms = results.costs.get(slow.run_id), results.costs.get(fast.run_id)
    ratio = paired_ratio(slow_ms, fast_ms) if slow_ms is not None and fast_ms is not None else None
    if ratio is None or ratio.pairs == 0:
        return Ratio(slow.cost_ms_median / fast.cost_ms_median, np.nan, np.nan, 0)
    return ratio


def verdict(low, high):
    if np.isnan(low) or np.isnan(high):
        return "not known"
    return "faster" if low > 1 else "slower" if high < 1 else "no difference shown"


def speedup_row(results, rows, measure, target, base, subject, rival, over):
    """How many times as fast the subject is. The rival's cheapest setting may lie up to the neighbour that misses the target: the
    interval begins at the lower end for that one."""
    ratio = ratio_of_rows(results, rival, subject)
    missed, has_line = neighbour(results, rival, rows, measure, target)
    low, bracket = ratio.low, "none"
    if missed is not None:
        low, bracket = np.fmin(low, ratio_of_rows(results, missed, subject).low) if not np.isnan(low) else low, "closed"
    elif has_line:
        low, bracket = np.nan, "open"  # cheaper settings were not listed: the rival may be faster than this
    return {**base, "kind": "speedup", "technique": subject.technique, "target": target, "over": over,
            "over_technique": rival.technique, "setting": describe(results, rival, rows), "run_id": rival.run_id,
            **quality(rival, measure), **times(rival), "speedup": ratio.median, "speedup_ci_low": low,
            "speedup_ci_high": ratio.high, "pairs": ratio.pairs, "bracket": bracket, "verdict": verdict(low, ratio.high)}


def times(row):
    return {"time_ms": row.cost_ms_median, "time_ms_ci_low": row.cost_ms_ci_low, "time_ms_ci_high": row.cost_ms_ci_high,
            "fetches_mean": row.fetches_mean}


def quality(row, measure):
    """The measure that is asked for, and recall, precision and F1 against the same truth."""
    prefix = "screen_" if measure.startswith("screen_") else ""
    return {"value": row[measure], **{name: row.get(f"{prefix}{name}_1px", np.nan) for name in ("recall", "precision", "f1")}}


def target_rows(results, rows, measure, base):
    """The cheapest setting of each technique that reaches each target, or the best that it reaches; and the subject's speed-ups
    over dda, over the best other technique and over linear at theirs."""
    for target in results.targets[measure]:
        reached = rows[reaches(rows, measure, target)]
        best = {technique: part.nsmallest(1, "cost_ms_median").iloc[0] for technique, part in reached.groupby("technique")}
        for technique in results.techniques:
            row = {**base, "kind": "cheapest_for_target", "technique": technique, "target": target}
            if technique not in best:
                known = rows[rows.technique == technique][measure]
                yield {**row, "setting": NOT_REACHED, "value": known.min() if measure.startswith("flip") else known.max()}
                continue
            one = best[technique]
            missed, _ = neighbour(results, one, rows, measure, target)
            yield {**row, "setting": describe(results, one, rows), "run_id": one.run_id, **quality(one, measure), **times(one),
                   "missed_by": None if missed is None else missed.run_id}
        if SUBJECT not in best:
            continue
        others = [one for technique, one in best.items() if technique != "dda" and not technique.startswith(SUBJECT)]
        rivals = [("dda", best.get("dda")), ("best other", min(others, key=lambda one: one.cost_ms_median, default=None)),
                  ("linear", best.get("linear"))]
        for over, rival in rivals:
            if rival is not None:
                yield speedup_row(results, rows, measure, target, base, best[SUBJECT], rival, over)


def equal_time_rows(results, rows, measure, base):
    """The best of each technique within the time that the most accurate setting takes, and within half of it."""
    if measure.startswith("flip"):
        return
    best = rows[rows[measure] >= rows[measure].max() - 1e-3].cost_ms_median.min()
    for share in (0.5, 1.0):
        within = rows[rows.cost_ms_median <= share * best]
        for technique in results.techniques:
            part = within[within.technique == technique]
            row = {**base, "kind": "best_within_time", "technique": technique, "time_budget_ms": share * best}
            if part.empty:
                yield {**row, "setting": "no setting is fast enough"}
                continue
            one = part.loc[part[measure].idxmax()]
            yield {**row, "setting": describe(results, one, rows), "run_id": one.run_id, **quality(one, measure), **times(one)}


def price_rows(results, rows, measure, base):
    """Along the Pareto front: milliseconds for each further 1 % of the measure."""
    if measure.startswith("flip"):
        return
    front = pareto(rows.assign(error=1 - rows[measure]), "cost_ms_median", "error")
    before = None
    for _, one in front.iterrows():
        row = {**base, "kind": "marginal_price", "technique": one.technique, "setting": describe(results, one, rows),
               "run_id": one.run_id, **quality(one, measure), **times(one)}
        if before is not None:
            row["price_ms_per_percent"] = (one.cost_ms_median - before.cost_ms_median) / (100 * (one[measure] - before[measure]))
        before = one
        yield row


COLUMNS = ["scene", "view", "width", "height", "measure", "kind", "technique", "target", "over", "over_technique",
           "time_budget_ms", "setting", "run_id", "missed_by", "value", "recall", "precision", "f1", "time_ms",
           "time_ms_ci_low", "time_ms_ci_high", "fetches_mean", "speedup", "speedup_ci_low", "speedup_ci_high", "pairs",
           "bracket", "verdict", "price_ms_per_percent"]


def summary(results):
    """The derived rows, the headline first; none without a measure."""
    derived = []
    for _, _, rows in results.pictures():
        first = rows.iloc[0]
        for measure in results.targets:
            known = rows[rows[measure].notna()] if measure in rows else rows.iloc[:0]
            if known.empty:
                continue
            base = {"scene": first.scene, "view": first["view"], "width": first.width, "height": first.height,
                    "measure": measure}
            for make in (target_rows, equal_time_rows, price_rows):
                derived.extend(make(results, known, measure, base))
    derived.sort(key=lambda row: row["kind"] != "speedup")
    return pd.DataFrame(derived, columns=COLUMNS)


ALL = [accuracy_curves]
