"""report.html, one file that needs nothing beside it, and report.md, the same in short. Templates: templates/."""
import json
import math
import os
import shlex

import jinja2
import pandas as pd

from .data import describe
from .pictures import data_uri, shots
from .results import counted, inputs_of, unit_of
from .tables import error_table, failed_table, plan_of, plain_table, ranking_table, row_table, split_of, SPLIT
from .verdict import goal, goal_text, has_value, milliseconds, picks, ranking, verdicts

TEMPLATES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "templates")
LIBRARY = "/usr/share/javascript/chart.js/chart.min.js"  # Debian's libjs-chart.js
# Of framework/compare/pictures.cpp.
AGREEMENT = [("#009e73", "found within 1 px"), ("#f0e442", "hit farther away"), ("#d55e00", "missed"), ("#cc79a7", "hit where nothing is"),
             ("#6b6b74", "rightly no hit"), ("#000000", "does not reflect")]
CAUSES = [("#e69f00", "own surface"), ("#56b4e9", "not shown"), ("#f0e442", "thin"), ("#cc79a7", "silhouette"), ("#009e73", "edge"),
          ("#d55e00", "stopped"), ("#ffffff", "other"), ("#6b6b74", "right")]
RAMP = "#1d1147, #51127c, #b73779, #fc8961, #fcfdbf"
ERRORS = {"f1_1px": "1 − F1 (scene truth)", "recall_1px": "1 − recall (scene truth)", "precision_1px": "1 − precision (scene truth)",
          "flip_visible": "FLIP over visible rays", "screen_recall_1px": "1 − recall (screen truth)",
          "screen_precision_1px": "1 − precision (screen truth)", "screen_f1_1px": "1 − F1 (screen truth)"}
COSTS = {"cost_ms_median": "trace + structures, ms", "fetches_mean": "fetches per ray", "steps_mean": "steps per ray"}


def error_of(row, measure):
    return row[measure] if measure.startswith("flip") else 1 - row[measure]


def plain(value):
    """For JSON: numbers short, missing values null. An unlimited setting is a word: JSON knows no infinity."""
    if pd.isna(value):
        return None
    if isinstance(value, float) and math.isinf(value):
        return str(float(value))
    if isinstance(value, (int, str)):
        return value
    return float(f"{float(value):.5g}") if not hasattr(value, "dtype") or value.dtype.kind == "f" else value.item()


def specification_path(results):
    """As it was given to `ssrlab run`."""
    words = shlex.split(results.environment.get("command_line", ""))
    return next((word for word in words if word.endswith(".toml")), "SPECIFICATION.toml")


def program(results):
    words = shlex.split(results.environment.get("command_line", ""))
    return words[0] if words else "build/bin/ssrlab"


def given_options(results, names=("--techniques", "--device")):
    """Those of the program itself, as they were given to `ssrlab run`."""
    words = shlex.split(results.environment.get("command_line", ""))
    return [option for name in names for at, word in enumerate(words[:-1]) if word == name
            for option in (name, words[at + 1])]


def again(results, run):
    """Measures one run again, in a folder of its own."""
    return " ".join([program(results), *map(shlex.quote, given_options(results))] + ["run", specification_path(results), "--only", run, "-o", f"again/{run}"])


def as_option(value):
    """As -p reads it: a column of whole numbers with gaps is one of floats."""
    if pd.api.types.is_bool(value):
        return str(bool(value)).lower()
    return value if isinstance(value, str) else repr(float(value)).removesuffix(".0")


def ray_command(results, row):
    """Explains a ray of the run; --pixel X,Y comes behind it. Passes around the trace do not change what it finds."""
    passes = results.environment.get("pass_parameters", "").split() + ["sources", "hand_on"]
    words = ["ray", shlex.quote(row.scene), "--view", shlex.quote(row["view"]), "--size", f"{row.width}x{row.height}", "-t", row.technique]
    for name, column in (("--frame", "frame"), ("--jitter", "jitter_phases")):
        words += [name, f"{row[column]:g}"] if row.get(column, 0) > 0 else []
    for name in inputs_of(results.all_rows):
        words += ["-p", f"{name}={as_option(row[name])}"] if name not in passes and has_value(row, name) else []
    return " ".join([program(results), *map(shlex.quote, given_options(results))] + words)


def chart_data(results, chosen):
    """Everything that the page's script shows: each run with its errors, costs and all values."""
    dropped = {"run_id", "experiment", "outcome", "message", "series", "frame_name", "scene", "view", "width", "height"}
    columns = [name for name in results.rows if name not in dropped and results.rows[name].notna().any()]
    runs, cloud = {}, {}
    for title, _, rows in results.pictures():
        for _, row in rows.iterrows():
            costs = {name: plain(row[name]) for name in COSTS if has_value(row, name)}
            runs[row.run_id] = {
                "frame": title, "series": row.series, "name": describe(results, row, rows), "time": milliseconds(row),
                "floor": 0.5 / max(1.0, row.rays), "picture": plain(row.picture) if "picture" in row else None,
                "costs": {**costs, "fetches": costs.get("fetches_mean")},
                "errors": {name: plain(error_of(row, name)) for name in ERRORS if has_value(row, name)},
                "commands": [["Measure it again:", again(results, row.run_id)]], "ray": ray_command(results, row), "size": [int(row.width), int(row.height)], "values": [plain(row[name]) for name in columns]}
        for series, line in rows.groupby("series"):
            # Several numbers vary: a cloud of points, not a line.
            cloud[series] = cloud.get(series, False) or sum(line[name].nunique() > 1 for name in results.swept(rows)) > 1
    return {"runs": runs, "columns": columns, "units": [unit_of(name, results.environment) for name in columns], "errors": ERRORS, "costs": COSTS,
            "styles": results.chart_styles, "cloud": cloud, "findings": dict(verdicts(results, chosen))}


def with_pictures(results, chosen):
    """One frame of each scene and view has its pictures inside the file: the largest that is at most 1280 wide."""
    if chosen.empty:
        return set()
    frames = chosen.drop_duplicates("frame_title")
    frames = frames.assign(large=frames.width > 1280).sort_values(["large", "width"], ascending=[True, False], kind="stable")
    return set(frames.drop_duplicates(["scene", "view"]).frame_title)


def frame_sections(results, chosen):
    pictured, said = with_pictures(results, chosen), dict(verdicts(results, chosen))
    for title, name, rows in results.pictures():
        part = chosen[chosen.frame_title == title]
        pictures, left, shape, pairs = shots(results, part, rows) if title in pictured else ([], 0, "", [])
        images = [image for shot in pictures for image in shot["images"]]
        numbers = {image["name"]: i for i, image in reversed(list(enumerate(images)))}  # of a run's five the picture is the first
        pairs = [{"words": words, "left": numbers[one], "right": numbers[other]} for words, one, other in pairs]
        yield {"title": title, "anchor": name, "verdict": said.get(title, ""), "pictures": pictures, "pairs": pairs,
               "aspect": shape, "more_pictures": f"{left} more runs have pictures in pictures/." if left > 0 else "",
               "split": split_of(part), "errors": error_table(part), "plan": plan_of(results, part), "rows": row_table(results, rows, part)}


def about(environment):
    identity = environment.get("identity", {})
    lines = {"command": environment.get("command_line"), "commit": environment.get("commit"), "device": identity.get("device"),
             "driver": identity.get("driver"), "processor": identity.get("processor"), "system": environment.get("system"),
             "started": environment.get("started"), "seed": environment.get("seed")}
    return [(name, value) for name, value in lines.items() if value]


def ranking_text(results, chosen):
    measure, target = goal(results)
    if measure is None:
        return "No truth was computed, so the table compares only times and work: every setting, the fastest first."
    frames = chosen.frame_title.nunique()
    text = (f"Each tracer at its cheapest setting that finds {goal_text(measure, target)}, with an F1 within one point of its best such setting; "
            "one that never does, at its nearest setting, behind the others. ")
    if chosen.worse_surface.any():
        text += ("A worse surface model makes a tracer cheaper and its answers worse. So those over a surface model stand behind the others "
                 "where the same technique has an F1 more than a point better over another model. ")
    return text + (f"Shares are means over {frames} frames, times and the ends of their intervals geometric means." if frames > 1 else "")


def lacking(results):
    """What a frame file does not say of what the surface model asks."""
    if "frame_lacks" not in results.all_rows:
        return []
    rows = results.all_rows[results.all_rows.frame_lacks.notna()].drop_duplicates(["scene", "surface", "frame_lacks"])
    return [f"{row.scene} has no channel {row.frame_lacks}: surface = {row.surface} takes every surface of this frame as thin."
            for row in rows.itertuples()]


def context(results, plots, tables):
    environment, chosen = results.environment, picks(results)
    counts = results.all_rows.outcome.value_counts()
    device = environment.get("identity", {}).get("device")
    ranked = ranking(results, chosen)
    return {"title": environment.get("title") or os.path.basename(os.path.abspath(results.folder)),
            "counts": f"{counted(len(results.all_rows), 'run')}: " + ", ".join(f"{n} {outcome}" for outcome, n in counts.items()) + ".",
            "device": f"Device: {device}." if device else "", "on_cpu": environment.get("device_type", "").lower() == "cpu",
            "verdicts": verdicts(results, chosen), "ranking": ranking_table(ranked), "ranking_text": ranking_text(results, chosen),
            "has_curve": results.sources.empty and any(results.has(name) for name in ERRORS), "frames": list(frame_sections(results, chosen)),
            "lacking": lacking(results), "failed": failed_table(results, again), "plots": plots, "tables": [(name, plain_table(rows)) for name, rows in tables.items()],
            "about": about(environment), "again": again(results, "RUN_ID"), "specification": environment.get("specification", ""),
            "agreement_legend": AGREEMENT, "causes_legend": CAUSES, "ramp": RAMP, "split_legend": [{"kind": kind, "said": said} for _, kind, said in SPLIT],
            "data": chart_data(results, chosen)}


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(results, plots, tables):
    """plots: those of folder.draw(). Returns the verdicts."""
    if not os.path.exists(LIBRARY):
        raise SystemExit(f"plot: {LIBRARY}: no such file; install libjs-chart.js")
    whole = context(results, plots, tables)
    # What the interactive curve shows is not shown twice.
    shown = [{**plot, "src": data_uri(plot["path"], flat=True, width=1600)} for plot in plots if not plot["curve"]]
    engine = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=jinja2.select_autoescape(["html.jinja"]),
                                trim_blocks=True, lstrip_blocks=True)
    data = json.dumps(whole["data"], ensure_ascii=False, allow_nan=False).replace("</", "<\\/")
    pages = {"report.html": {**whole, "plots": shown, "data": data, "css": read(os.path.join(TEMPLATES, "report.css")),
                             "script": read(os.path.join(TEMPLATES, "report.js")), "library": read(LIBRARY)},
             "report.md": whole}
    for name, values in pages.items():
        with open(os.path.join(results.folder, name), "w", encoding="utf-8") as file:
            file.write(engine.get_template(f"{name}.jinja").render(values))
    return whole["verdicts"]
