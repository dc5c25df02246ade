"""Draws how the cost of a ray grows with the picture, from a sweep over sizes.

    build/bin/ssrlab run experiments/resolution.toml
    experiments/plot growth results/resolution -o growth.png
"""

import argparse
import os
import sys

from .data import Results
from .figures import draw_growth


def main(words):
    parser = argparse.ArgumentParser(prog="plot growth", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", help="a results folder with several sizes")
    parser.add_argument("--scene", default="thin_yard")
    parser.add_argument("--view", default="default")
    parser.add_argument("-o", "--output", default="growth.png", metavar="FILE.png")
    options = parser.parse_args(words)
    if not os.path.exists(os.path.join(options.folder, "results.csv")):
        sys.exit(f"plot growth: {options.folder}: holds no results.csv; make one with ssrlab run")
    results = Results(options.folder)
    rows = results.rows[(results.rows.scene == options.scene) & (results.rows["view"] == options.view)]
    if rows.empty:
        sys.exit(f"plot growth: {options.folder}: no row of {options.scene}, view {options.view}")
    device = results.environment.get("identity", {}).get("device", "a device that is not known")
    draw_growth(results, rows, f"{options.scene}, view {options.view}, {device}", {}).savefig(options.output)
    print(options.output)
