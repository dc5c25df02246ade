"""All plots and the report of a results folder."""
import os
import sys

from matplotlib import pyplot as plt

from . import accuracy, effects, figures, gpu, panels, report, sequences, sources, surfaces
from .data import Results
from .results import counted

INTERACTIVE = accuracy.ALL  # the report shows these as one chart to choose from


def axes_of(figure):
    """What is drawn against what, for those who do not see it."""
    along, up = ([label for label in dict.fromkeys(getattr(axis, f"get_{name}label")().replace("\n", " ") for axis in figure.axes) if label] for name in "xy")
    return " against ".join(" and ".join(labels) for labels in (up, along) if labels)


def draw(results, folder):
    """([{"name", "shows", "finding", "path", "curve"}], tables)."""
    os.makedirs(folder, exist_ok=True)
    plots, tables = [], {}
    # A specification that names its figures wants these. Runs that differ in their sources alone have the same tracer.
    usual = figures.ALL + accuracy.ALL + effects.ALL + surfaces.ALL + sequences.ALL + gpu.ALL
    usual = usual if results.sources.empty else sources.ALL
    for make in panels.ALL if panels.figures_of(results) else usual:
        for name, figure in (make(results, tables) if len(results.rows) else ()):
            for extension in ("png", "svg"):
                figure.savefig(os.path.join(folder, f"{name}.{extension}"))
                figure.set_layout_engine("none")  # the second file has the places of the first
            plt.close(figure)
            plots.append({"name": name, "shows": axes_of(figure) or name.replace("_", " "), "finding": figure.finding,
                          "path": os.path.join(folder, f"{name}.png"), "curve": make in INTERACTIVE})
    return plots, tables


def main(folder, bandwidth_gbps=None):
    if os.path.basename(folder) == "results.csv":
        folder = os.path.dirname(folder) or "."
    if not os.path.exists(os.path.join(folder, "results.csv")):
        sys.exit(f"plot: {folder}: holds no results.csv; make one with ssrlab run")
    results = Results(folder, bandwidth_gbps)
    plots, tables = draw(results, os.path.join(folder, "plots"))
    for name, table, digits in (("summary.csv", accuracy.summary(results), "%.6g"), ("surfaces.csv", surfaces.ladder(results), "%.5g")):
        if len(table):
            table.to_csv(os.path.join(folder, name), index=False, float_format=digits)
    for frame, text in report.write(results, plots, tables):
        print(f"{frame}: {text}")
    if not plots and len(results.rows) and results.sources.empty:
        print(f"plot: no plot: curves need {accuracy.FEWEST_RUNS} runs of a frame that differ in a setting")
    print(f"{os.path.join(folder, 'report.html')}: {counted(len(plots), 'plot')}, {len(results.rows)} of {counted(len(results.all_rows), 'row')} ok")
