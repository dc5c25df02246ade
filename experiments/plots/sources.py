"""Answers beyond the frame: what share of the rays each list of sources answers rightly and at what cost, what the frame lacks, and what
each source brings back. Each function returns its figures."""
import numpy as np
import pandas as pd

from .paper import log_axis, name_lines, sheet, titled

LOST = {"hidden": "hidden", "off_screen": "off screen", "behind_camera": "behind the camera", "facing_away": "facing away"}
COLOURS = {"hidden": "#0072B2", "off_screen": "#E69F00", "behind_camera": "#009E73", "facing_away": "#CC79A7"}
SAID = {"layers:count=4:sides=front": "4 layers, front", "layers:count=2:sides=both": "2 layers, both sides",
        "layers:count=4:sides=both": "4 layers, both sides", "planar": "planar reflection", "views:count=1": "1 view",
        "views:count=2": "2 views"}


def said(source):
    """A source of a list in words; one with other parameters as "cube size_px 256"."""
    return SAID.get(source, source.replace(":", " ").replace("=", " "))


def said_value(value):
    return f"{value:g}" if isinstance(value, float) else value


def asks_frame_alone(step):
    return step[0] == ("frame",)


def step_name(step, tracer):
    """"frame", "+ cube + world": what is asked behind the frame begins with a plus. `tracer`: the name of the frame's own step."""
    sources, hand_on = step
    if asks_frame_alone(step):
        return hand_on or tracer  # of another tracer, its name stands there
    words = [said(one) for one in sources]
    name = " + ".join(words) if len(words) == 1 or words[0] != "frame" else "".join(f"+ {word} " for word in words[1:]).strip()
    return name + (" alone" if sources == ("world",) else "") + (" (lost)" if hand_on == "lost" else "")


def asked_rows(results):
    """sources.csv with the frame of each run, its tracer, and what was spent up to each source. Empty if no run asked any."""
    if results.sources.empty:
        return results.sources
    inputs = [name for name in results.varying(results.rows) if name not in ("sources", "hand_on")]
    runs = results.rows.set_index("run_id")
    rows = results.sources[results.sources.run_id.isin(runs.index)].copy()
    for name in ("scene", "view", "frame_name", "sources", "hand_on"):
        rows[name] = rows.run_id.map(runs[name])
    rows["tracer"] = [", ".join([runs.technique[run]] + [f"{name} {said_value(runs[name][run])}" for name in inputs if pd.notna(runs[name][run])])
                      for run in rows.run_id]
    rows["number"] = rows.run_id.map({run: number for number, run in enumerate(results.rows.sort_values("run_number", kind="stable").run_id)})
    rows = rows.sort_values(["number", "place"])
    spent = rows.draw_ms + rows.trace_ms + rows.shade_ms
    for name, values in (("spent_ms", spent), ("spent_megabytes", rows.megabytes), ("all_visits", rows.node_visits)):
        rows[name] = values.groupby(rows.run_id).cumsum()
    # A lone source is handed all rays, whatever the rule.
    rows["step"] = [(tuple(row.sources.split(",")[:row.place + 1]), row.hand_on if row.place > 0 else "") for row in rows.itertuples()]
    return rows


def frame_labels(rows):
    """{frame_name: the scene, with its view or frame where there are several}."""
    frames = rows.drop_duplicates("frame_name")
    several = frames.scene.duplicated(keep=False)
    return {row.frame_name: row.frame_name.replace(", view default", "").rsplit(", ", 1)[0] if twice else row.scene.removeprefix("builtin:")
            for row, twice in zip(frames.itertuples(), several)}


def geometric(values):
    """The mean of those that took any time; 0 if none did."""
    spent = values[values > 0]
    return float(np.exp(np.log(spent).mean())) if len(spent) else 0.0


def steps_of(rows, tracer="frame"):
    """A row a step of the ladder that every frame has: means over the frames, geometric for times; the cheapest first."""
    frames, steps = rows.frame_name.nunique(), []
    for step, part in rows.groupby("step", sort=False):
        once = part.groupby("frame_name").agg({"all_recall": "first", "all_precision": "first", "all_f1": "first", "all_visits": "first",
                                               "spent_ms": "median", "spent_megabytes": "first"})
        if len(once) == frames and once.all_recall.notna().all():
            steps.append({"step": step, "name": step_name(step, tracer), "ms": geometric(once.spent_ms), "recall": once.all_recall.mean(),
                          "precision": once.all_precision.mean(), "f1": once.all_f1.mean(), "megabytes": once.spent_megabytes.mean(),
                          "visits": once.all_visits.mean()})
    return pd.DataFrame(steps).sort_values("ms").reset_index(drop=True) if steps else pd.DataFrame()


def front_of(steps):
    """Steps that no cheaper one equals; steps are sorted by time."""
    return steps[steps.f1 > steps.f1.cummax().shift(fill_value=-1)]


def ladder_finding(steps):
    """The message: the worst and the best that the frame alone can do, and the cheapest list within half a point of the best, against the
    triangles alone."""
    alone = steps[steps.name == "world alone"]
    others = steps[steps.name != "world alone"]
    best = others[others.f1 >= others.f1.max() - 0.005].iloc[0]
    of_frame = steps[[asks_frame_alone(step) for step in steps.step]].sort_values("f1")
    worst_and_best = of_frame.iloc[sorted({0, len(of_frame) - 1})] if len(of_frame) else of_frame
    found = [f"{100 * f1:.0f} % by {'the frame' if name == 'frame' else name}" for f1, name in zip(worst_and_best.f1, worst_and_best.name)]
    if not asks_frame_alone(best.step):
        time = f"{best.ms / alone.ms.iloc[0]:.2g} times the time of the world alone" if len(alone) else f"{best.ms:.3g} ms"
        found.append(f"{100 * best.f1:.1f} % by “{best['name']}”, in {time}")
    return "F1 over all rays: " + ", ".join(found)


def draw_ladder(steps):
    """All steps have names, or, where they are many, those on the Pareto front, the frame and the triangles alone."""
    figure, ((axis,),) = sheet(2.3)
    front = front_of(steps)
    few = len(steps) <= 10
    named = steps[few | steps.index.isin(front.index) | (steps.name == "world alone") | [asks_frame_alone(step) for step in steps.step]]
    axis.step(front.ms, 100 * front.f1, where="post", color="#999999", zorder=1)
    axis.plot(steps.ms, 100 * steps.f1, "o", mfc="white", mec="#777777", mew=0.8, ls="none")
    axis.plot(front.ms, 100 * front.f1, "o", color="#0072B2", ls="none")
    axis.set_ylabel("F1 over all rays, %")
    axis.set_xlabel("drawing, tracing and lighting, ms")
    log_axis(axis.xaxis)
    axis.margins(0.07, 0.12)
    name_lines(axis, [(row.name, row.ms, 100 * row.f1, "#0072B2" if row.Index in front.index else "#555555") for row in named.itertuples()])
    lost = "; (lost): gets only rays without an answer yet" if named.name.str.contains("(lost)", regex=False).any() else ""
    titled(figure, ladder_finding(steps), f"line: Pareto front{lost}")
    return figure


def names_of(tracers):
    """{tracer: its technique and surface}, and what else it takes to tell them apart."""
    words = {tracer: tracer.split(", ") for tracer in tracers}
    brief = {tracer: ", ".join(word.removeprefix("surface ").replace("_", " ") for i, word in enumerate(all_words) if i == 0 or word.startswith("surface "))
             for tracer, all_words in words.items()}
    alike = {tracer: [words[other] for other in tracers if brief[other] == brief[tracer]] for tracer in tracers}
    return {tracer: ", ".join([brief[tracer]] + [word.replace("_m ", " ") for word in words[tracer] if any(word not in other for other in alike[tracer])])
            for tracer in tracers}


def ladders(rows):
    """(tracer, its rows, its steps) of each ladder. What `auto` chose differs from frame to frame: it is one step."""
    if rows.empty:
        return
    whole = ~rows.sources.str.startswith("auto") | ~rows.duplicated("run_id", keep="last")
    rows = rows.assign(step=[((row.sources,), "") if row.sources.startswith("auto") else row.step for row in rows.itertuples()])[whole]
    # Tracers that ask nothing but the frame are steps of the ladder of those that ask further sources.
    asks_more = rows.tracer.isin(rows.tracer[rows.place > 0]) | (rows.place == 0).all()
    names = names_of(rows.tracer.unique())
    frames = rows[~asks_more].assign(step=[(("frame",), names[tracer]) for tracer in rows.tracer[~asks_more]])
    for tracer, part in rows[asks_more].groupby("tracer"):
        steps = steps_of(pd.concat([frames, part]), "frame" if frames.empty else names[tracer])
        if len(steps) >= 2:
            yield tracer, part, steps


def ladder(results, tables):
    """What each further source adds, and what it costs: a step a source."""
    for place, (_, _, steps) in enumerate(ladders(asked_rows(results))):
        yield "sources_ladder" + (f"_{place}" if place > 0 else ""), draw_ladder(steps)


def lost_share(row, cls):
    return 100 * row[f"handed_{cls}"] / row.all_meeting if row.all_meeting else 0


def lost_by_class(results, tables):
    """Of the rays that meet geometry, those whose point the frame does not show, by the reason."""
    rows = asked_rows(results)
    if rows.empty:
        return
    names = frame_labels(rows)
    first = rows[rows.place == 0].drop_duplicates("frame_name").iloc[::-1]
    if not sum(first[f"handed_{cls}"].sum() for cls in LOST):
        return
    figure, ((axis,),) = sheet(0.75 + 0.17 * len(first))
    left = np.zeros(len(first))
    for cls, word in LOST.items():
        wide = np.array([lost_share(row, cls) for _, row in first.iterrows()])
        axis.barh(range(len(first)), wide, left=left, color=COLOURS[cls], label=word, height=0.75)
        left += wide
    for y, total in enumerate(left):
        axis.annotate(f"{total:.0f}", (total, y), textcoords="offset points", xytext=(3, 0), va="center")
    axis.set_yticks(range(len(first)), [names[name] for name in first.frame_name])
    axis.grid(False, axis="y")
    axis.margins(0.1, 0.02)
    axis.set_xlim(left=0)
    axis.set_xlabel("of the rays that meet geometry, %")
    axis.legend(loc="lower right", bbox_to_anchor=(1.04, 1), ncols=4, handlelength=0.9, columnspacing=0.9, handletextpad=0.4,
                borderaxespad=0.2)
    largest = max(LOST, key=lambda cls: sum(lost_share(row, cls) for _, row in first.iterrows()))
    span = f"{left.min():.0f} to {left.max():.0f}" if len(left) > 1 else f"{left[0]:.0f}"
    titled(figure, f"The frame lacks {span} % of the points that rays meet; the largest part is {LOST[largest]}")
    yield "sources_lost_by_class", figure


def remedies_of(rows):
    """Lists of the frame and one more source but the triangles: those that get lost rays alone, where there are such."""
    pairs = rows[(rows.place == 1) & rows.sources.str.startswith("frame,") & (rows.sources.str.count(",") == 1) & (rows.source != "world")]
    lost = pairs[pairs.hand_on == "lost"]
    pairs = lost if len(lost) else pairs
    right = sum(pairs[f"right_{cls}"] for cls in LOST)
    frames = rows[rows.place == 0].set_index("run_id")
    lost_rays = sum(pairs.run_id.map(frames[f"handed_{cls}"]) for cls in LOST)
    return pairs.assign(back=100 * right / lost_rays.where(lost_rays > 0), rightly=100 * pairs.right / pairs.points.where(pairs.points > 0),
                        remedy=[said(source) for source in pairs.source])


def back_text(back, rightly):
    """"28 (87)"; without brackets where the source gave no point."""
    brackets = f" ({rightly:.0f})" if pd.notna(rightly) else ""
    return f"{back:.0f}{brackets}" if pd.notna(back) else ""


def back_grids(rows):
    """Frames by remedies: of the lost rays, the share answered rightly; of the answers, the share that is right. Empty without remedies."""
    pairs = remedies_of(rows) if len(rows) else rows
    if pairs.empty:
        return pairs, pairs
    grid = pairs.pivot_table("back", "frame_name", "remedy", sort=False)
    right = pairs.pivot_table("rightly", "frame_name", "remedy", sort=False).reindex_like(grid)
    names = frame_labels(rows)
    for one in (grid, right):
        if len(one) > 1:
            one.loc["mean"] = one.mean()
        one.index = [names.get(name, name) for name in one.index]
    return grid, right


def brought_back(results, tables):
    """Of the lost rays, the share that each source answers rightly."""
    grid, _ = back_grids(asked_rows(results))
    if grid.empty:
        return
    figure, ((axis,),) = sheet(0.95 + 0.18 * len(grid))
    axis.imshow(grid, cmap="Blues", vmin=0, vmax=100, aspect="auto")
    for (y, x), value in np.ndenumerate(grid.to_numpy()):
        if np.isfinite(value):
            axis.text(x, y, f"{value:.0f}", ha="center", va="center", color="white" if value > 60 else "black")
    axis.set_xticks(range(len(grid.columns)), grid.columns, rotation=40, ha="right", rotation_mode="anchor")
    axis.set_yticks(range(len(grid)), grid.index)
    axis.grid(False)
    axis.tick_params(length=0)
    best, most = grid.iloc[-1].idxmax(), grid.iloc[-1].max()
    mean = " in the mean" if len(grid) > 1 else ""
    titled(figure, f"“{best}” answers most of the lost rays rightly: {most:.0f} %{mean}" if most >= 0.5 else "No source here answers a lost ray rightly")
    yield "sources_brought_back", figure


def share(part, whole):
    return f"{100 * part / whole:.1f}" if whole > 0 else ""


def hybrid_lines(name, part):
    """The frame with the triangles behind it, directly or behind the resumed frame, against the triangles alone."""
    alone = part[part.sources == "world"]
    for sources in ("frame,world", "frame,resume,world"):
        both = part[(part.sources == sources) & (part.hand_on == "uncertain")]
        if both.empty or alone.empty:
            continue
        frame, world, only = both.iloc[0], both.iloc[-1], alone.iloc[0]
        lost = sum(frame[f"handed_{cls}"] for cls in LOST)
        yield {"frame": name, "list": sources, "lost, %": share(lost, frame.all_meeting), "F1 of the frame, %": f"{100 * frame.all_f1:.1f}",
               "F1 with world, %": f"{100 * world.all_f1:.2f}", "certain hits that are right, %": share(frame.certain_right, frame.certain_points),
               "world gets, of rays that meet geometry, %": share(world.meeting, frame.meeting),
               "of rays that meet nothing, %": share(world.handed - world.meeting, frame.handed - frame.meeting),
               "time / world alone": f"{world.spent_ms / only.spent_ms:.2f}",
               "node visits / world alone": f"{world.node_visits / only.node_visits:.2f}"}


def chosen_lines(name, part):
    """What `auto` chose in one frame, and the fixed list, or beginning of a list, that answers most for no more time."""
    auto = part[part.sources.str.startswith("auto")].drop_duplicates("run_id", keep="last")
    fixed = part[~part.sources.str.startswith("auto") & ((part.hand_on == "uncertain") | (part.place == 0))]
    for one in auto.itertuples():
        asked = part[part.run_id == one.run_id]
        affordable = fixed[fixed.spent_ms <= 1.05 * one.spent_ms]
        best = affordable.loc[affordable.all_f1.idxmax()] if len(affordable) else None
        yield {"frame": name, "budget": one.sources.removeprefix("auto:").replace("=", " "), "chosen": ",".join(asked.source), "ms": f"{one.spent_ms:.0f}",
               "F1, %": f"{100 * one.all_f1:.1f}", "best fixed list for no more time": "" if best is None else ",".join(best.step[0]),
               "its F1, %": "" if best is None else f"{100 * best.all_f1:.1f}", "choosing, s": f"{asked.choosing_ms.iloc[0] / 1000:.0f}"}


def mirror_lines(name, part):
    """What a planar reflection costs beside the trace of the frame, over the share of the picture that reflects."""
    planar, frame = part[part.sources == "planar"], part[part.sources == "frame"]
    if len(planar) != 1 or len(frame) != 1:
        return
    planar, frame = planar.iloc[0], frame.iloc[0]
    width, height = map(int, frame.frame_name.rsplit(", ", 1)[1].split("×"))
    yield {"frame": name, "picture that reflects, %": share(frame.handed, width * height),
           "frame: ms": f"{frame.spent_ms:.0f}", "recall, %": f"{100 * frame.all_recall:.1f}", "precision, %": f"{100 * frame.all_precision:.1f}",
           "planar: ms": f"{planar.spent_ms:.0f}", "planar: recall, %": f"{100 * planar.all_recall:.1f}",
           "planar: precision, %": f"{100 * planar.all_precision:.1f}" if planar.points else "", "time, planar / frame": f"{planar.spent_ms / frame.spent_ms:.1f}"}


# By title: what makes the lines of one frame.
LINES = {"The frame with the triangles behind it, against the triangles alone": hybrid_lines,
         "What auto chose, against the fixed lists": chosen_lines, "A planar reflection beside the frame": mirror_lines}


def tables_of(results):
    """{title: rows} of all that the sources answered."""
    rows, tables = asked_rows(results), {}
    for tracer, part, steps in ladders(rows):
        frames = part.frame_name.nunique()
        tables[f"Ladder of {tracer}" + (f": means over {frames} frames, geometric for times" if frames > 1 else "")] = [
            {"": i + 1, "sources": step.name, "ms": f"{step.ms:.3g}", "recall, %": f"{100 * step.recall:.1f}",
             "precision, %": f"{100 * step.precision:.1f}", "F1, %": f"{100 * step.f1:.1f}", "MB": f"{step.megabytes:.1f}",
             "node visits": f"{step.visits:.0f}"} for i, step in enumerate(steps.itertuples())]
    grid, right = back_grids(rows)
    if len(grid):
        tables["Lost rays that a source answers rightly, %; in brackets, how many of its answers are right, %"] = [
            {"frame": frame, **{name: back_text(grid.loc[frame, name], right.loc[frame, name]) for name in grid.columns}} for frame in grid.index]
    names = frame_labels(rows) if len(rows) else {}
    for title, make in LINES.items():
        lines = [line for (frame, _), part in rows.groupby(["frame_name", "tracer"], sort=False) for line in make(names[frame], part)] if names else []
        if lines:
            tables[title] = lines
    return tables


def add_tables(results, tables):
    """No figure: what the figures show, in numbers, and more."""
    tables.update(tables_of(results))
    return ()


ALL = [ladder, lost_by_class, brought_back, add_tables]
