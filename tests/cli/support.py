"""Runs the built program; a test that fails says how to repeat its last command."""
import csv
import glob
import importlib.machinery
import importlib.util
import os
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.environ.get("SSRLAB", os.path.join(SOURCE, "build", "bin", "ssrlab"))

HANGS_S = 1500 # what takes longer hangs; a busy machine is only slow

SWEEP = """
scenes = ["builtin:stairs", "builtin:sphere_over_mirror", "builtin:corridor"]
sizes  = ["64x36"]
[trace]
max_distance_m = 9
[techniques.linear]
steps = [8, 16, 32, 64]
[techniques.dda]
[measure]
min_repeats = 2
max_repeats = 4
budget_s    = 0.2
"""
SWEEP_ROWS = 15


def read(*path):
    """The text of a file of the tree."""
    with open(os.path.join(SOURCE, *path), encoding="utf-8") as file:
        return file.read()


def load_script(*path):
    """A script of the tree without ending, such as experiments/bench, as a module."""
    loader = importlib.machinery.SourceFileLoader(path[-1], os.path.join(SOURCE, *path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(path[-1], loader))
    loader.exec_module(module)
    return module


def browser(folder, width, height, flags):
    """Chromium without a window, with its console kept, of this viewport; raises SkipTest with the reason."""
    try:
        from selenium import webdriver
        from selenium.webdriver.chrome.options import Options
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        raise unittest.SkipTest("python3-selenium is not installed")
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        raise unittest.SkipTest("chromium or chromium-driver is not installed")
    options = Options()
    for one in ("headless=new", "no-sandbox", "no-first-run", "hide-scrollbars", f"user-data-dir={folder}", *flags):
        options.add_argument("--" + one)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    page = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
    return page


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="ssrlab_cli_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = dict(os.environ, SSRLAB_CACHE=self.path("cache"))
        self.environment.pop("SSRLAB_TECHNIQUES", None)
        self.last_command = ""

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def text(self, name):
        """Of a file in the test's folder."""
        return read(self.path(name))

    def bytes(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def keep_lines(self, name, count):
        """As if the program had been killed after so many lines of this table."""
        with open(self.path(name), "r+b") as file:
            file.truncate(sum(len(file.readline()) for _ in range(count)))

    def start(self, *arguments, limits=None, **environment):
        """A running ssrlab."""
        self.last_command = " ".join([f"{k}={shlex.quote(v)}" for k, v in environment.items()] +
                                     [shlex.quote(a) for a in (PROGRAM,) + arguments])
        return subprocess.Popen([PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                env=dict(self.environment, **environment), cwd=self.folder, preexec_fn=limits)

    def ssrlab(self, *arguments, code=0, says=(), limits=None, **environment):
        """Runs to the end; checks the exit code and that stdout and stderr hold every text of `says`."""
        process = self.start(*arguments, limits=limits, **environment)
        out, err = process.communicate(timeout=HANGS_S)
        story = f"\nrepeat: {self.last_command}\nstdout: {out}\nstderr: {err}"
        self.assertEqual(process.returncode, code, "exit code" + story)
        for text in says:
            self.assertIn(text, out + err, story)
        return out + err

    def refused(self, *arguments, code, says, **more):
        """An error is one line on stderr that begins with the program's name, and it leaves no output behind."""
        text = self.ssrlab(*arguments, code=code, says=says, **more)
        errors = [line for line in text.splitlines() if line.startswith("ssrlab: ")]
        self.assertEqual(len(errors), 1, f"one line of error\nrepeat: {self.last_command}\n{text}")
        return text

    def need_amd(self):
        if not glob.glob("/usr/share/vulkan/icd.d/radeon_icd.*"):
            self.skipTest("no driver for AMD GPUs: install Debian's package mesa-vulkan-drivers")

    def rows(self, folder="out", table="results.csv"):
        with open(os.path.join(self.path(folder), table), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def samples(self, folder="out"):
        """samples.csv as {run id: {pass: [(round, ms), …]}}."""
        samples = {}
        for one in self.rows(folder, "samples.csv"):
            passes = samples.setdefault(one["run_id"], {})
            passes.setdefault(one["pass"], []).append((int(one["round"]), float(one["ms"])))
        return samples

    def whole_rows(self, folder="out"):
        """Rows in the file so far, 0 before there is one."""
        path = os.path.join(self.path(folder), "results.csv")
        if not os.path.exists(path):
            return 0
        with open(path, encoding="utf-8") as file:
            return max(0, file.read().count("\n") - 1)

    def stop_in_the_middle(self, process, which):
        """Sends the signal once the first row is written; returns the exit code."""
        until = time.monotonic() + HANGS_S
        while self.whole_rows() == 0 and process.poll() is None and time.monotonic() < until:
            time.sleep(0.01)
        self.assertIsNone(process.poll(), f"ended before it was stopped\nrepeat: {self.last_command}")
        process.send_signal(which)
        process.communicate(timeout=HANGS_S)
        return process.returncode

    def assert_complete(self, rows, count):
        self.assertEqual([row["outcome"] for row in rows], ["ok"] * count, f"repeat: {self.last_command}\n{rows}")
        self.assertEqual(len({row["run_id"] for row in rows}), count)
        self.assert_samples(rows)

    def assert_samples(self, rows):
        """Every row has the samples of each of its repeats and all of its passes, once; nothing else has any."""
        samples = self.samples()
        passes = [(one["run_id"], one["pass"]) for one in self.rows(table="passes.csv")]
        self.assertEqual(len(set(passes)), len(passes))
        self.assertEqual({run for run, _ in passes}, set(samples))
        self.assertEqual(set(samples), {row["run_id"] for row in rows if row["repeats"]})
        for row in rows:
            for name, values in samples[row["run_id"]].items():
                rounds = [number for number, _ in values]
                self.assertEqual(len(set(rounds)), int(row["repeats"]), f"{row['run_id']} {name} {rounds}")
                self.assertEqual(len(rounds), int(row["repeats"]), f"{row['run_id']} {name} {rounds}")


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)
    unittest.main()
