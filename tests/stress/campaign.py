"""Runs the random campaigns of the hard cases with a hundred million rays each."""
import os
import subprocess


def add_options(parser):
    parser.add_argument("--rays", type=int, default=100_000_000, help="in each of the two campaigns (default: 100,000,000)")


def run(options, _):
    tests = os.path.join(os.path.dirname(options.program), "hard_cases")
    done = subprocess.run([tests, "--gtest_filter=*Campaign*"], env={**os.environ, "SSRLAB_LONG": str(options.rays)}, check=False)
    return [f"{tests} ended with exit code {done.returncode}"] if done.returncode else [], f"2 campaigns of {options.rays:,} rays"
