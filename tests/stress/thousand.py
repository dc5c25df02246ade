"""Times a sweep of a thousand tiny runs on two cores: with nothing compiled before at most 90 s.

On a machine that does other things: chrt -f 1 tests/stress/run thousand"""
import os
import time

from sweeps import rows_of, sweep, write

LONGEST_S = 90
SPEC = """name = "thousand"
scenes = ["builtin:sphere_over_mirror"]
sizes  = ["64x36"]
[passes]
pass_set = "shading"
hit_shading = "diffuse"
[trace]
surface        = "box"
behind         = "hit"
thickness_m    = [0.05, 0.1, 0.2, 0.4]
max_distance_m = 9
dielectric_min_f0 = 1
[techniques.linear]
steps = {steps}
[measure]
warmup_s    = 0
min_repeats = 1
max_repeats = 1
budget_s    = 0
double_twin = false
pictures    = false
"""


def add_options(parser):
    parser.add_argument("--runs", type=int, default=1000, help="a multiple of 4 (default: 1000)")


def run(options, folder):
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])
    spec = write(os.path.join(folder, "thousand.toml"), SPEC.format(steps=list(range(1, options.runs // 4 + 1))))
    broken, seconds = [], []
    for name in ("first", "again"):
        begin, out = time.monotonic(), os.path.join(folder, name)
        sweep(options.program, spec, out, MESA_SHADER_CACHE_DIR=os.path.join(folder, "mesa"))
        seconds.append(time.monotonic() - begin)
        rows = sum(row["outcome"] == "ok" for row in rows_of(out).values())
        if rows != options.runs:
            broken.append(f"{rows} rows, expected {options.runs}")
    if seconds[0] > LONGEST_S * options.runs / 1000:
        broken.append(f"{seconds[0]:.1f} s, at most {LONGEST_S * options.runs / 1000:g} s are wanted")
    return broken, f"{options.runs} runs: {seconds[0]:.1f} s, then {seconds[1]:.1f} s with what the driver kept"
