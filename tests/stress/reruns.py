"""Runs a sweep of every technique again and again, on one thread and on two: all that no clock decides must be the same, bit by bit."""
import glob
import os

from plots.results import OF_TIME
from sweeps import differences, pictures_of, rows_of, sweep, write

TECHNIQUES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "techniques")
SPEC = """name = "reruns"
scenes = ["builtin:stairs", "builtin:puddle", "builtin:gloss_steps"]
sizes  = ["97x55"]
[trace]
max_distance_m = 9
{techniques}[measure]
min_repeats = 2
max_repeats = 2
"""


def add_options(parser):
    parser.add_argument("--times", type=int, default=2, metavar="N", help="reruns, by turns on one thread and on two (default: 2)")


def run(options, folder):
    names = sorted(os.path.basename(os.path.dirname(path)) for path in glob.glob(os.path.join(TECHNIQUES, "*", "technique.toml")))
    spec = write(os.path.join(folder, "reruns.toml"), SPEC.format(techniques="".join(f"[techniques.{name}]\n" for name in names)))
    found = []
    for number in range(options.times + 1):
        out = os.path.join(folder, f"out{number}")
        sweep(options.program, spec, out, LP_NUM_THREADS=("1", "2")[number % 2])
        found.append((rows_of(out), pictures_of(out)))
    broken = [f"rerun {number}: {what}" for number, other in enumerate(found) for what in differences(found[0], other)]
    rows, pictures = found[0]
    values = sum(not OF_TIME.search(column) for row in rows.values() for column in row)
    return broken, f"{options.times} reruns of {len(rows)} rows: {len(broken)} of {values} values and {len(pictures)} pictures differ"
