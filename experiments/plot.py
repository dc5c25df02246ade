#!/usr/bin/python3
"""Plots and report of a results folder: plot.py DIR reads DIR/results.csv and writes DIR/plots, summary.csv and report.*

Each plot is made only if the folder holds the data that it needs.
"""
import os
import sys

try:
    import jinja2  # noqa: F401
    import matplotlib  # noqa: F401
    import pandas  # noqa: F401
    import PIL  # noqa: F401
except ImportError as error:
    sys.exit(f"plot.py: {error}; install python3-matplotlib, python3-pandas, python3-pil and python3-jinja2, and run it with /usr/bin/python3")

import plot_accuracy
import plot_effects
import plot_figures
import plot_gpu
import plot_panels
import plot_report
import plot_sequences
import plot_surfaces
from matplotlib import pyplot as plt
from plot_data import Results

INTERACTIVE = plot_accuracy.ALL  # the report shows these as one chart to choose from


def draw(results, folder):
    """([{"name", "alt", "path", "curve"}], tables); an alt text says what a plot shows."""
    os.makedirs(folder, exist_ok=True)
    plots, tables = [], {}
    # A specification that names its figures wants these.
    usual = plot_figures.ALL + plot_accuracy.ALL + plot_effects.ALL + plot_surfaces.ALL + plot_sequences.ALL + plot_gpu.ALL
    for make in plot_panels.ALL if plot_panels.figures_of(results) else usual:
        for name, figure in (make(results, tables) if len(results.rows) else ()):
            for extension in ("png", "svg"):
                figure.savefig(os.path.join(folder, f"{name}.{extension}"))
            plt.close(figure)
            plots.append({"name": name, "alt": (getattr(figure, "finding", "") or name.replace("_", " ")) + ".",
                          "path": os.path.join(folder, f"{name}.png"), "curve": make in INTERACTIVE})
    return plots, tables


def main(folder):
    if not os.path.exists(os.path.join(folder, "results.csv")):
        sys.exit(f"plot.py: {folder}: holds no results.csv; make one with ssrlab run")
    results = Results(folder)
    plots, tables = draw(results, os.path.join(folder, "plots"))
    summary = plot_accuracy.summary(results)
    if len(summary):
        summary.to_csv(os.path.join(folder, "summary.csv"), index=False, float_format="%.6g")
    surfaces = plot_surfaces.ladder(results)
    if len(surfaces):
        surfaces.to_csv(os.path.join(folder, "surfaces.csv"), index=False, float_format="%.5g")
    for frame, text in plot_report.write(results, plots, tables):
        print(f"{frame}: {text}")
    print(f"{os.path.join(folder, 'report.html')}: {len(plots)} plots, {len(results.rows)} of {len(results.all_rows)} rows ok")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__ if "-h" in "".join(sys.argv[1:]) else "usage: plot.py DIR")
    main(sys.argv[1])
