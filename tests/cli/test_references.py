"""experiments/references: what an experiment makes is replaced, and nothing that failed or names no commit."""
import json
import os
import shutil
import subprocess

from support import PROGRAM, SOURCE, Case, main

REFERENCE = "results/reference/lavapipe/tiny"
EXPERIMENT = """
scenes = ["builtin:stairs"]
sizes  = ["64x36"]
[passes]
gloss = ["off", "blur"]
[techniques.linear]
steps = STEPS
[measure]
min_repeats = 2
max_repeats = 4
budget_s    = 0.2
"""
# The built program, except that the commit in environment.json is the one asked for.
WRAPPER = f"""#!/bin/bash
"{PROGRAM}" "$@" || exit $?
sed -i -E 's/"commit": "[^"]*"/"commit": "'"$COMMIT"'"/' results/tiny/environment.json
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.write("experiments/tiny.toml", EXPERIMENT.replace("STEPS", "[8, 16]"))
        shutil.copy(os.path.join(SOURCE, "experiments/references"), self.path("experiments"))
        shutil.copytree(os.path.join(SOURCE, "experiments/plots"), self.path("experiments/plots"))
        os.chmod(self.write("build/bin/ssrlab", WRAPPER), 0o755)
        self.write(REFERENCE + "/environment.json", json.dumps(
            {"experiment": "tiny", "command_line": "build/bin/ssrlab --quiet run experiments/tiny.toml -o /elsewhere"}))
        for name in ("results.csv", "summary.csv", "by_hand.png"):
            self.write(f"{REFERENCE}/{name}", "old")

    def references(self, *names, code=0, commit="abc"):
        done = subprocess.run([self.path("experiments/references"), *names], capture_output=True, text=True,
                              env=dict(self.environment, COMMIT=commit), cwd=self.folder)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, code, said)
        return said

    def held(self, name):
        return self.text(f"{REFERENCE}/{name}")

    def test_what_an_experiment_makes_is_replaced(self):
        said = self.references()
        self.assertEqual({(row["steps"], row["gloss"]) for row in self.rows(REFERENCE)}, {("8", "off"), ("16", "off"), ("8", "blur"), ("16", "blur")})
        self.assertEqual(set(self.rows("results/tiny")[0]) - set(self.rows(REFERENCE)[0]) & {"picture", "surface", "trace_resolution", "frame_ms_median"},
                         {"picture", "trace_resolution"})
        self.assertIn("linear", self.held("summary.csv"))
        environment = json.loads(self.held("environment.json"))
        self.assertEqual(environment["commit"], "abc")
        self.assertEqual(environment["constants"]["trace_resolution"], "full")
        self.assertNotIn("gloss", environment["constants"])
        self.assertNotIn("samples", environment)
        self.assertNotIn("/elsewhere", environment["command_line"])
        self.assertEqual(self.held("by_hand.png"), "old")
        self.assertIn("by_hand.png stays: no run makes it", said)
        self.assertNotIn("summary.csv stays", said)

    def test_nothing_is_replaced_without_a_commit(self):
        self.assertIn("expected a commit, got 'abc with changes'", self.references("tiny", code=1, commit="abc with changes"))
        self.assertEqual(self.held("results.csv"), "old")

    def test_nothing_is_replaced_when_a_run_fails(self):
        self.write("experiments/tiny.toml", EXPERIMENT.replace("STEPS", "[0]"))
        self.assertIn("failed", self.references("tiny", code=1))
        self.assertEqual(self.held("results.csv"), "old")

    def test_an_unknown_name_is_named(self):
        self.assertIn("results/reference/lavapipe/other: expected a folder that an experiment made, one of tiny", self.references("other", code=1))


if __name__ == "__main__":
    main()
