"""Which tracer to choose: the setting of each that is compared, the ranking over all frames, and a sentence for each frame."""
import numpy as np
import pandas as pd

from .accuracy import ratio_of_rows
from .data import describe

F1_SLACK = 0.01
MISSES = {"visible_displaced": "hit another point", "missed_not_in_depth": "are missed by exact tracers as well", "missed_stopped": "are stopped",
          "missed_stepped_over": "are stepped over", "missed_out_of_steps": "run out of steps",
          "missed_facing_rule": "are refused by the facing rule"}
FALSE_HITS = {"false_self": "on the reflector itself", "false_too_thick": "behind a surface that is taken too thick",
              "false_wrong_surface": "on a surface that the true ray does not meet"}


def has_value(row, name):
    return name in row and pd.notna(row[name])


def goal(results):
    """(measure, target): what a tracer must find to be compared by its time; (None, None) without truths."""
    for measure in ("screen_recall_1px", "recall_1px"):
        targets = [value for value in results.targets.get(measure, [0.99]) if value <= 0.99]
        if targets and results.has(measure):
            return measure, max(targets)
    return None, None


def goal_text(measure, target):
    whole = "the depth buffer holds" if measure == "screen_recall_1px" else "the frame shows"
    return f"{percent(target)} of what {whole}"


def percent(share):
    return f"{100 * share:.3g} %"


def milliseconds(row, name="cost_ms"):
    text = f"{row[f'{name}_median']:.3g} ms"
    if has_value(row, f"{name}_ci_low") and has_value(row, f"{name}_ci_high"):
        text += f" [{row[f'{name}_ci_low']:.3g}, {row[f'{name}_ci_high']:.3g}]"
    return text


def f1_of(rows, measure):
    """The F1 of each run: of the scene, of the screen, or the measure itself, whichever the rows have."""
    return rows[next((name for name in ("f1_1px", "screen_f1_1px") if name in rows and rows[name].notna().any()), measure)]


def pick(rows, measure, target):
    """The cheapest run that reaches the target with an F1 within one point of the best of those that do; else the nearest to it."""
    reached = rows[rows[measure] >= target]
    if reached.empty:
        reached = rows[rows[measure] >= rows[measure].max() - 1e-3]
    f1 = f1_of(reached, measure)
    return reached[f1 >= f1.max() - F1_SLACK].nsmallest(1, "cost_ms_median").index


def over_worse_surface(rows, f1, reached):
    """Which rows reach the target over a surface model over which a technique has an F1 more than a point below its own over another:
    a time there buys less, whoever traces. f1: against the scene, since each surface model has a screen truth of its own."""
    if "surface" not in rows or f1 is None:
        return reached & False
    best = f1.where(reached).groupby([rows.technique, rows.surface]).max()
    worse = best[best < best.groupby("technique").transform("max") - F1_SLACK]
    return reached & rows.surface.isin(worse.index.get_level_values("surface"))


def picks(results):
    """The compared run of every series on every frame, the best first. Without truths: every setting. None if the runs compare sources."""
    measure, target = goal(results)
    parts = []
    for title, _, rows in results.pictures() if results.sources.empty else ():
        chosen = rows.assign(frame_title=title, reached=False, setting=[describe(results, row, rows) for _, row in rows.iterrows()])
        if measure is None:
            chosen = chosen.assign(label=chosen.setting).drop_duplicates("setting").sort_values("cost_ms_median")
        else:
            places = [place for _, part in rows[rows[measure].notna()].groupby("series") for place in pick(part, measure, target)]
            chosen = chosen.loc[places]
            chosen = chosen.assign(label=chosen.series, reached=chosen[measure] >= target, missing=(target - chosen[measure]).clip(lower=0))
            chosen = chosen.assign(f1=f1_of(chosen, measure))
            chosen = chosen.assign(worse_surface=over_worse_surface(chosen, chosen.get("f1_1px"), chosen.reached))
            chosen = chosen.sort_values(["missing", "worse_surface", "cost_ms_median"])
        parts.append(chosen)
    return pd.concat(parts) if parts else results.rows.iloc[:0].assign(label="", frame_title="", reached=False, worse_surface=False, setting="")


def mean_of(part, name):
    return part[name].mean() if name in part else np.nan


def geometric(part, name):
    return float(np.exp(np.log(part[name]).mean())) if name in part and part[name].notna().all() and (part[name] > 0).all() else np.nan


def ranking(results, chosen):
    """A row a series: means over the frames, geometric for times. Those that reach the target everywhere come first, by time, and of them
    those over worse surface models last."""
    measure, _ = goal(results)
    frames = chosen.frame_title.nunique()
    rows = []
    for label, part in chosen.groupby("label", sort=False):
        rows.append({"label": label, "series": part.series.iloc[0], "technique": part.technique.iloc[0], "frames": len(part), "of": frames,
                     "reached": int(part.reached.sum()), "screen_recall": mean_of(part, "screen_recall_1px"),
                     "recall": mean_of(part, "recall_1px"), "precision": mean_of(part, "precision_1px"), "f1": mean_of(part, "f1_1px"),
                     "false_hits": mean_of(part, "false_hits"), "flip": mean_of(part, "flip_visible"),
                     "fetches": mean_of(part, "fetches_mean"),
                     **({"surface": part.surface.iloc[0]} if "surface" in part else {}),
                     **{name: geometric(part, name) for name in ("cost_ms_median", "cost_ms_ci_low", "cost_ms_ci_high")}})
    table = pd.DataFrame(rows)
    if table.empty:
        return table
    table["unreached"] = table.of - table.reached if measure else 0
    nearness = {"screen_recall_1px": "screen_recall", "recall_1px": "recall", None: "label"}[measure]
    table["nearness"] = -table[nearness].where(table.unreached > 0, 1) if measure else 0
    table["worse_surface"] = over_worse_surface(table, table.f1, table.unreached == 0)
    return table.sort_values(["unreached", "nearness", "worse_surface", "cost_ms_median"]).drop(columns=["nearness", "worse_surface"]).reset_index(drop=True)


def named(row):
    """"hiz (max_steps 64)": the tracer, and its setting in brackets."""
    name, comma, setting = row.setting.partition(", ")
    return f"{name} ({setting})" if comma else name


def causes(row, total, names, floor=0.0005):
    """The two largest, and the rest of the total: ": 7 % are stopped, 2 % hit another point, 1 % for other reasons"."""
    shares = sorted(((row[name], said) for name, said in names.items() if has_value(row, name) and row[name] >= floor), reverse=True)[:2]
    said = [f"{percent(share)} {cause}" for share, cause in shares]
    rest = total - sum(share for share, _ in shares)
    return ": " + ", ".join(said + [f"{percent(rest)} for other reasons"] * (rest >= floor)) if said else ""


def left_wrong(row):
    """What the chosen tracer still gets wrong, and why: sentences."""
    sentences = []
    if has_value(row, "recall_1px"):
        missed = 1 - row.recall_1px
        sentences.append(f"It misses {percent(missed)} of what the frame shows{causes(row, missed, MISSES)}.")
    if has_value(row, "false_hits"):
        sentences.append(f"{percent(row.false_hits)} of its rays end in a false hit{causes(row, row.false_hits, FALSE_HITS)}.")
    return " ".join(sentences)


def with_causes(text, best):
    intervals = "In brackets: 95 % intervals. " if "[" in text else ""
    return f"{text}. {intervals}{left_wrong(best)}".rstrip()


def verdict(results, chosen):
    """The sentences for one frame; chosen: its picks, the best first."""
    measure, target = goal(results)
    if measure is None or chosen.empty:
        return ""
    best = chosen.iloc[0]
    if not best.reached:
        return with_causes(f"No tracer finds {goal_text(measure, target)}. The nearest is {named(best)}: {percent(best[measure])} in "
                           f"{milliseconds(best)}", best)
    quicker = chosen.worse_surface & (chosen.cost_ms_median < best.cost_ms_median)
    rivals = chosen[chosen.reached & ~quicker & (chosen.technique != best.technique)].drop_duplicates("technique").head(2)
    alone, faster = True, []
    for _, rival in rivals.iterrows():
        ratio = ratio_of_rows(results, rival, best)
        times = f"{ratio.median:.3g}" + (f" [{ratio.low:.3g}, {ratio.high:.3g}]" if pd.notna(ratio.low) else "")
        within_noise = pd.notna(ratio.low) and ratio.low <= 1 <= ratio.high
        alone &= not within_noise
        faster.append(f"as fast as {named(rival)} within the noise: {times} times" if within_noise else f"{times} times as fast as {named(rival)}")
    text = f"{named(best)} is {'the cheapest tracer that finds' if alone else 'one of the cheapest tracers that find'} {goal_text(measure, target)}: {milliseconds(best)}"
    if faster:
        text += ", " + " and ".join(faster)
    for _, row in chosen[quicker & (chosen.f1 < best.f1 - F1_SLACK)].head(1).iterrows():
        text += f". {named(row)} takes {milliseconds(row)}, but has an F1 of {percent(row.f1)} instead of {percent(best.f1)}"
    return with_causes(text, best)


def verdicts(results, chosen):
    """[(frame, sentences)]"""
    said = [(title, verdict(results, part)) for title, part in chosen.groupby("frame_title", sort=False)]
    return [(title, text) for title, text in said if text]
