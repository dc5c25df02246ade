"""What walks would cost on a GPU that is not there: the instructions that Mesa compiles for it, times the iterations that were counted."""
import json
import os
import shutil
import subprocess

from .report import given_options, program
from .verdict import picks

CHIP = "navi21"
HEADING = "What this would cost on RDNA2, by its compiler"
BUILT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../build/bin/ssrlab")


def traces_of(results, techniques, surface):
    """Each technique's trace pipeline as `ssrlab shaders --json` describes it; none where that compiler is not installed or refuses."""
    tool = next((path for path in (program(results), BUILT) if shutil.which(path)), None)
    if tool is None:
        return {}
    command = [tool, *given_options(results, ["--techniques"]), "shaders", *techniques, "--chip", CHIP, "-p", f"surface={surface}", "--json"]
    said = subprocess.run(command, capture_output=True, text=True, check=False)
    pipelines = json.loads(said.stdout)["pipelines"] if said.returncode == 0 else []
    return {technique: one for one in pipelines if one["shader"].startswith("trace/trace") for technique in one["techniques"]}


def table(results, tables):
    """One line a technique and surface model: each at the setting that the ranking compares, as a mean over the frames."""
    chosen = picks(results)
    if "wave128_iterations_mean" not in chosen or chosen.wave128_iterations_mean.isna().all():
        return ()
    traces = {surface: traces_of(results, list(rows.technique.unique()), surface) for surface, rows in chosen.groupby("surface")}
    lines = []
    for (technique, surface), rows in chosen.groupby(["technique", "surface"], sort=False):
        trace = traces[surface].get(technique)
        if trace is None:
            continue
        rays = 128 if "trace_pairs" in trace["shader"] else 64  # that a wave of 64 holds
        counts, loop, iterations = trace["statistics"], trace["innermost_loop"]["instructions"], rows[f"wave{rays}_iterations_mean"].mean()
        lines.append({"technique": technique, "surface": surface, "VGPRs": counts["VGPRs"], "spills": counts["Spilled VGPRs"],
                      "waves a SIMD": counts["Subgroups per SIMD"], "group": trace["invocations_a_group"], "innermost loop": loop,
                      "iterations of a wave": round(iterations, 2), "wave instructions a ray": round(loop * iterations / rays, 1)})
    if lines:
        tables[HEADING] = sorted(lines, key=lambda line: line["wave instructions a ray"])
    return ()


ALL = [table]


def compiled_traces(path):
    """What a compiler makes of each trace for a GPU that is not there: the commit, and a row a technique."""
    found = json.loads(path.read_text(encoding="utf-8"))
    counts = {"VGPRs": "VGPRs", "spilled": "Spilled VGPRs", "waves a SIMD": "Subgroups per SIMD", "bytes": "Code size"}
    return found["commit"], [{"technique": technique, **{said: one["statistics"][name] for said, name in counts.items()},
                              "instructions of the innermost loop": one["innermost_loop"]["instructions"], "loads there": one["innermost_loop"]["loads"]}
                             for one in found["pipelines"] if one["shader"].startswith("trace/trace") for technique in one["techniques"]]
