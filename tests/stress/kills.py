"""Ends a small sweep again and again by signals and resumes it: nothing may be lost, doubled, torn or different.

A sweep is ended while it starts, at any time, or right after one of its files grew. SIGKILL must lose no row that was written; SIGINT,
SIGTERM, SIGHUP, SIGQUIT and SIGPIPE must leave whole rows, too, and exit code 128 + their number."""
import collections
import csv
import os
import random
import shutil
import signal
import subprocess
import time

from sweeps import differences, pictures_of, read, rows_of, sweep, write

SPEC = """name = "kills"
scenes = ["builtin:stairs", "builtin:corridor"]
sizes  = ["16x9", "24x14", "32x18"]
[passes]
pass_set = "shading"
[trace]
max_distance_m = 9
[techniques.linear]
steps = [4, 6, 8]
[measure]
min_repeats = 2
max_repeats = 2
"""
STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE)
FILES = ("environment.json", "samples.csv", "passes.csv", "sources.csv", "results.csv")


class Broken(Exception):
    pass


def whole_lines(out):
    """{run id: line} of results.csv, and whether a part of a line follows."""
    *lines, rest = read(out, "results.csv").split("\n")
    ids = [line.split(",", 1)[0] for line in lines[1:]]
    if len(set(ids)) < len(ids):
        raise Broken("a row is there twice")
    return dict(zip(ids, lines[1:])), rest != ""


def sizes(out):
    return [os.stat(path).st_size if os.path.exists(path) else -1 for path in (os.path.join(out, name) for name in FILES)]


def wait(process, draw, out, longest_s):
    """Until a drawn moment, or the process's end."""
    end = time.monotonic() + draw.uniform(0, longest_s)
    changes, before = draw.choice((0, draw.randint(1, 4))), sizes(out)
    while process.poll() is None and (changes > 0 or time.monotonic() < end):
        time.sleep(0.0005)
        if changes > 0 and (now := sizes(out)) != before:
            changes, before, end = changes - 1, now, 0
    if end == 0:
        time.sleep(draw.choice((0, draw.uniform(0, 0.005))))


def end_once(command, environment, out, which, draw, longest_s, seen):
    """Starts the sweep and ends it; the rows that are written now, and whether it came to its end first."""
    log = out + ".log"
    with open(log, "wb") as file:
        process = subprocess.Popen(command, stdout=file, stderr=file, env=environment, start_new_session=True)
    wait(process, draw, out, longest_s)
    try:
        (os.killpg if draw.random() < 0.5 else os.kill)(process.pid, which)  # as a terminal does; or the program alone
    except ProcessLookupError:
        pass
    code = process.wait(timeout=300)
    rows, torn = whole_lines(out)
    if lost := [run_id for run_id, line in seen.items() if rows.get(run_id) != line]:
        raise Broken(f"rows lost or changed after {which.name}: {', '.join(lost)}")
    asked = which != signal.SIGKILL
    early = code == -which and len(rows) == len(seen)  # before it listens, a signal ends it as it ends any program
    if code != 0 and not (asked and early) and code != (128 + which if asked else -which):
        raise Broken(f"exit code {code} after {which.name}: {read(log)}")
    if torn and (asked or code == 0):
        raise Broken(f"a torn row after {which.name}")
    return rows, code == 0


def check_finished(out, expected, expected_pictures):
    if differ := differences((expected, expected_pictures), (rows_of(out), pictures_of(out))):
        raise Broken("differs from a sweep that nobody stopped: " + ", ".join(differ[:9]))
    passes = collections.Counter(row["run_id"] for row in csv.DictReader(read(out, "passes.csv").splitlines()) if row["ran"] == "true")
    if passes != {run_id: int(row["passes_ran"]) for run_id, row in expected.items()}:
        raise Broken("passes.csv does not hold each pass once")
    rounds = {}
    for line in read(out, "samples.csv").splitlines()[1:]:
        run_id = line.split(",", 1)[0]
        rounds.setdefault(run_id, []).append(line.rsplit(",", 1)[0])
    if rounds.keys() != expected.keys() or any(len(set(lines)) < len(lines) for lines in rounds.values()):
        raise Broken("samples.csv does not hold each timed pass once")
    if left := [name for _, _, names in os.walk(out) for name in names if ".tmp" in name]:
        raise Broken("files left over: " + ", ".join(left))


def add_options(parser):
    parser.add_argument("--times", type=int, default=20, metavar="N", help="signals; every fourth asks it to stop (default: 20)")
    parser.add_argument("--seed", type=int, default=1, help="of the moments (default: 1)")


def run(options, folder):
    spec, draw, broken = write(os.path.join(folder, "kills.toml"), SPEC), random.Random(options.seed), []
    # Lavapipe without threads: for so small a picture they would only wait for each other.
    environment = {**os.environ, "SSRLAB_CACHE": os.path.join(folder, "cache"), "LP_NUM_THREADS": "0"}
    for name in ("cold", "whole"):
        begin, whole = time.monotonic(), os.path.join(folder, name)
        sweep(options.program, spec, whole, LP_NUM_THREADS="0")
    whole_s, expected, pictures = time.monotonic() - begin, rows_of(whole), pictures_of(whole)
    signals = [STOPS[i // 4 % len(STOPS)] if i % 4 == 3 else signal.SIGKILL for i in range(options.times)]
    ended, sweeps = 0, 0
    while ended < options.times and not broken:
        out, seen, done = os.path.join(folder, f"out{sweeps}"), {}, False
        try:
            while not done:
                command = [options.program, "--quiet", "run", spec, "-o", out] + (["--resume"] if os.path.isdir(out) else [])
                if ended == options.times:
                    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
                    break
                seen, done = end_once(command, environment, out, signals[ended], draw, whole_s, seen)
                ended += not done
            check_finished(out, expected, pictures)
        except Broken as error:
            broken.append(f"{error}\n  repeat: tests/stress/run kills --seed {options.seed} --times {options.times}")
        sweeps += 1
        shutil.rmtree(out, ignore_errors=True)
    return broken, f"{ended} signals, {sweeps} sweeps of {len(expected)} rows: {len(broken)} promises broken"
