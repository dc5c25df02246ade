"""tests/reruns: counts, quality and pictures are the same each time; what differs is found."""
import importlib.machinery
import importlib.util
import os
import subprocess

from support import PROGRAM, SOURCE, Case, main

RERUNS = os.path.join(SOURCE, "tests", "reruns")


class Test(Case):
    def test_the_same_each_time(self):
        done = subprocess.run([RERUNS, "--program", PROGRAM, "--times", "2"], capture_output=True, text=True, timeout=280)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"2 reruns of [1-9]\d+ rows: 0 of [1-9]\d+ values and [1-9]\d+ pictures differ")

    def test_what_differs_is_found(self):
        loader = importlib.machinery.SourceFileLoader("reruns", RERUNS)
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("reruns", loader))
        loader.exec_module(module)
        first = ({"r1": {"steps_mean": "3", "trace_ms_median": "1", "hiz.ms_median": "1"}}, {"a.png": b"1"})
        same = ({"r1": {"steps_mean": "3", "trace_ms_median": "2", "hiz.ms_median": "2"}}, {"a.png": b"1"})
        self.assertEqual(module.differences(first, same), [])
        self.assertEqual(module.differences(first, ({"r1": {**same[0]["r1"], "steps_mean": "4"}}, same[1])), ["r1 steps_mean"])
        self.assertEqual(module.differences(first, (same[0], {"a.png": b"2", "b.png": b"1"})), ["a.png", "b.png"])
        self.assertEqual(module.differences(first, ({}, {})), ["the list of runs"])


if __name__ == "__main__":
    main()
