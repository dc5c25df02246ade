"""Holds the source `world` to Embree's answers on ten million rays over the nine scenes."""
import os
import re
import subprocess

HEAD = ("| scene | rays | of pixels | meeting | in one place | edge | edge-on | at a limit | at a mask | wrong |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n")


def add_options(parser):
    parser.add_argument("--rays", type=int, default=10_000_000, help="in all scenes together (default: 10,000,000)")
    parser.add_argument("--only", default="*", metavar="SCENE", help="this scene alone (its share of the rays)")
    parser.add_argument("--table", metavar="FILE.md", help="writes how often each cause made a difference")


def run(options, _):
    tests = os.path.join(os.path.dirname(options.program), "source_tests")
    done = subprocess.run([tests, f"--gtest_filter=*WorldCampaign*/{options.only}"], stdout=subprocess.PIPE, text=True, check=False,
                          env={**os.environ, "SSRLAB_LONG": str(options.rays)})
    rows = re.findall(r"^\| .* \|$", done.stdout, re.MULTILINE)
    print(HEAD + "\n".join(rows))
    if options.table:
        with open(options.table, "w", encoding="utf-8") as file:
            file.write(HEAD + "\n".join(rows) + "\n")
    fields = [row.strip("| ").split(" | ") for row in rows]
    differ = sum(int(number) for row in fields for number in row[4:])
    broken = [line for line in done.stdout.splitlines() if "from (" in line]
    if done.returncode and not broken:
        broken = [f"{tests} ended with exit code {done.returncode}"]
    return broken, (f"{sum(int(row[1]) for row in fields):,} rays in {len(rows)} scenes: {differ:,} differ by rounding, "
                    f"{sum(int(row[-1]) for row in fields)} otherwise")
