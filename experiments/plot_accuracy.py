"""What the next bit of accuracy costs: the curves, their Pareto fronts, and the rows of summary.csv."""
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from plot_data import describe, label_of
from plot_figures import log_axis

NOT_REACHED = "not reached"
TARGETS = [0.90, 0.95, 0.99, 0.995]
# (column, what it is measured against)
RECALLS = [("recall_1px", "scene truth"), ("screen_recall_1px", "screen truth")]


def pareto(rows, cost, error):
    """Rows that no other row beats in both; cheapest first."""
    front, best = [], np.inf
    for index, row in rows.sort_values([cost, error]).iterrows():
        if row[error] < best:
            front.append(index)
            best = row[error]
    return rows.loc[front]


def drop_overlapping(labels):
    """Of labels that would cover each other the first stays."""
    kept = []
    for label in labels:
        box = label.get_window_extent()
        if any(box.overlaps(other) for other in kept):
            label.remove()
        else:
            kept.append(box)


def draw_curves(axis, results, rows, cost, error, xlabel):
    front, labels = pareto(rows, cost, error), []
    for series, line in rows.groupby("series"):
        varying = [name for name in results.swept(rows) if line[name].nunique() > 1]
        line = line.sort_values(varying or cost)
        style = dict(results.styles[series])
        named = line
        if len(varying) > 1:
            # Several numbers vary: a cloud, of which the front is what counts.
            style["linestyle"] = "none"
            named = line[line.index.isin(front.index)]
        axis.plot(line[cost], line[error], label=series, ms=5, lw=1.3, **style)
        for _, row in named.iterrows():
            labels.append(axis.annotate(label_of(results, row, rows), (row[cost], row[error]), textcoords="offset points", xytext=(4, 3),
                                        fontsize=6.5, color=results.styles[series]["color"]))
    axis.step(front[cost], front[error], where="post", color="#777777", lw=6, alpha=0.3, zorder=0, label="Pareto front",
              solid_capstyle="round")
    axis.set(xlabel=xlabel)
    log_axis(axis.xaxis)
    log_axis(axis.yaxis)
    drop_overlapping(labels)


def accuracy_curves(results, _):
    """Error against time and against fetches, log-log."""
    for title, name, rows in results.pictures():
        if len(rows) < 5 or not results.swept(rows):
            continue
        kinds = [(column, f"1 − recall within 1 px ({truth})") for column, truth in RECALLS]
        for column, ylabel in kinds + [("screen_displacement_p95_px", "hit displacement, 95th percentile, px")]:
            if not results.has(column) or rows[column].notna().sum() < 5:
                continue
            part = rows[rows[column].notna()].copy()
            exact = part[column] if "displacement" in column else 1 - part[column]
            floor = 1e-3 if "displacement" in column else 0.5 / max(1.0, part.rays.max())
            part["error"] = exact.clip(lower=floor)
            figure, (left, right) = plt.subplots(1, 2, figsize=(12.5, 5.4), sharey=True)
            draw_curves(left, results, part, "cost_ms_median", "error", "trace + structures, ms")
            draw_curves(right, results, part, "fetches_mean", "error", "fetches per ray")
            left.set_ylabel(ylabel)
            if (exact < floor).any():
                for axis in (left, right):
                    axis.axhline(floor, color="#999999", lw=0.8, ls=":")
                left.text(0.01, 0.01, "dotted: no error, or too small to draw", transform=left.transAxes, fontsize=8,
                          color="#666666")
            right.legend(fontsize=8.5, loc="best")
            figure.suptitle(title)
            yield f"accuracy_{column}_{name}", figure


def target_rows(results, rows, recall, base):
    """The cheapest setting of each technique that reaches each target, and its speed-up over linear; the best recall of one that does not
    reach it. The ends of the ratio's interval are the ratios of the ends of both intervals."""
    for target in TARGETS:
        reached = rows[rows[recall] >= target]
        linear = reached[reached.technique == "linear"].nsmallest(1, "cost_ms_median")
        for technique in results.techniques:
            row = {**base, "kind": "cheapest_for_target", "technique": technique, "target": target}
            best = reached[reached.technique == technique].nsmallest(1, "cost_ms_median")
            if best.empty:
                yield {**row, "setting": NOT_REACHED, "recall": rows[rows.technique == technique][recall].max()}
                continue
            one = best.iloc[0]
            row.update(setting=describe(results, one, rows), run_id=one.run_id, recall=one[recall],
                       time_ms=one.cost_ms_median, time_ms_ci_low=one.cost_ms_ci_low,
                       time_ms_ci_high=one.cost_ms_ci_high, fetches_mean=one.fetches_mean)
            if not linear.empty:
                other = linear.iloc[0]
                row.update(speedup_over_linear=other.cost_ms_median / one.cost_ms_median,
                           speedup_ci_low=other.cost_ms_ci_low / one.cost_ms_ci_high,
                           speedup_ci_high=other.cost_ms_ci_high / one.cost_ms_ci_low)
                if technique == "linear":  # against itself
                    row.update(speedup_ci_low=1.0, speedup_ci_high=1.0)
            yield row


def equal_time_rows(results, rows, recall, base):
    """The best recall of each technique within the time that the most accurate setting takes, and within half of it."""
    best = rows[rows[recall] >= rows[recall].max() - 1e-3].cost_ms_median.min()
    for share in (0.5, 1.0):
        within = rows[rows.cost_ms_median <= share * best]
        for technique in results.techniques:
            part = within[within.technique == technique]
            row = {**base, "kind": "best_within_time", "technique": technique, "time_budget_ms": share * best}
            if part.empty:
                yield {**row, "setting": "no setting is fast enough"}
                continue
            one = part.loc[part[recall].idxmax()]
            yield {**row, "setting": describe(results, one, rows), "run_id": one.run_id, "recall": one[recall],
                   "time_ms": one.cost_ms_median, "time_ms_ci_low": one.cost_ms_ci_low,
                   "time_ms_ci_high": one.cost_ms_ci_high, "fetches_mean": one.fetches_mean}


def price_rows(results, rows, recall, base):
    """Along the Pareto front: milliseconds for each further 1 % of recall."""
    front = pareto(rows.assign(error=1 - rows[recall]), "cost_ms_median", "error")
    before = None
    for _, one in front.iterrows():
        row = {**base, "kind": "marginal_price", "technique": one.technique, "setting": describe(results, one, rows),
               "run_id": one.run_id, "recall": one[recall], "time_ms": one.cost_ms_median,
               "time_ms_ci_low": one.cost_ms_ci_low, "time_ms_ci_high": one.cost_ms_ci_high,
               "fetches_mean": one.fetches_mean}
        if before is not None:
            row["price_ms_per_percent"] = (one.cost_ms_median - before.cost_ms_median) / (100 * (one[recall] - before[recall]))
        before = one
        yield row


COLUMNS = ["scene", "view", "width", "height", "recall_of", "kind", "technique", "target", "time_budget_ms", "setting",
           "run_id", "recall", "time_ms", "time_ms_ci_low", "time_ms_ci_high", "fetches_mean", "speedup_over_linear",
           "speedup_ci_low", "speedup_ci_high", "price_ms_per_percent"]


def summary(results):
    """The derived rows; none without a recall."""
    derived = []
    for _, _, rows in results.pictures():
        first = rows.iloc[0]
        for recall, _ in RECALLS:
            known = rows[rows[recall].notna()] if recall in rows else rows.iloc[:0]
            if known.empty:
                continue
            base = {"scene": first.scene, "view": first["view"], "width": first.width, "height": first.height,
                    "recall_of": recall}
            for make in (target_rows, equal_time_rows, price_rows):
                derived.extend(make(results, known, recall, base))
    return pd.DataFrame(derived, columns=COLUMNS)


ALL = [accuracy_curves]
