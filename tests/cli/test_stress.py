"""tests/stress: each command in its shortest form, and programs that break a promise are found."""
import os
import subprocess
import sys

from support import HANGS_S, PROGRAM, SOURCE, Case, main, read

sys.path[:0] = [os.path.join(SOURCE, *path) for path in (("tests", "stress"), ("tests", "fuzz"), ("experiments",))]
import hostile  # noqa: E402
import mutations  # noqa: E402
import sweeps  # noqa: E402


class Test(Case):
    def stress(self, *arguments, program=PROGRAM, code=0):
        command = [os.path.join(SOURCE, "tests", "stress", "run"), *arguments, "--program", program]
        done = subprocess.run(command, capture_output=True, text=True, timeout=HANGS_S)
        self.assertEqual(done.returncode, code, f"repeat: {' '.join(command)}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def program(self, *lines):
        """Does something else first, and is ssrlab then."""
        path = self.write("program", "\n".join(["#!/bin/sh", *lines, f'exec {PROGRAM} "$@"\n']))
        os.chmod(path, 0o755)
        return path

    def test_kills(self):
        table = self.path("stress.md")
        self.assertIn("5 signals", self.stress("kills", "--times", "5", "-o", table))
        self.assertRegex(read(table), r"\| `tests/stress/run kills --times 5 .*0 promises broken \|")

    def test_a_program_that_forgets_is_found(self):
        forgetful = self.program('for file in "$5"/results.csv; do [ -e "$file" ] && sed -i 2d "$file"; done')
        self.assertRegex(self.stress("kills", "--times", "8", program=forgetful, code=1), "rows lost or changed after SIG")

    def test_hostile(self):
        self.assertRegex(self.stress("hostile", "--each", "1", "--only", "glb/"), r"11 files of 1 kind\(s\): 0 promises broken")

    def test_a_program_that_falls_is_found(self):
        fragile = self.program("[ -p image.png ] && kill -SEGV $$")
        text = self.stress("hostile", "--only", "png/pipe", program=fragile, code=1)
        self.assertRegex(text, "BROKEN: exit code -11(.|\n)*repeat: tests/stress/run hostile --seed 1 --only 'png/pipe/0'")

    def test_each_broken_promise_is_found(self):
        names, good = ["a.png", "scene.gltf"], "ssrlab: a.png: cannot be decoded\n"
        for promise, code, said in ((None, 0, ""), (None, 1, good), (None, 2, "ssrlab: ./scene.gltf: no\n"), ("time", None, ""),
                                    ("exit code -11", -11, ""), ("exit code 3", 3, good), ("not one line", 1, ""), ("not one line", 1, good + good),
                                    ("not one line", 1, good + "and more\n"), ("file not named", 1, "ssrlab: it cannot be read\n"),
                                    ("control characters", 0, "a\x1b[2Jb\n")):
            self.assertEqual(hostile.broken_promise(code, said, names), promise, (code, said))

    def test_the_seed_decides_every_damage(self):
        content = bytes(range(256)) * 4
        for rule, change in {**hostile.ANY, **hostile.TEXT}.items():
            once, again = (change(content, hostile.random.Random(1)) for _ in range(2))
            self.assertEqual(once, again, rule)
            self.assertNotEqual(once, content, rule)

    def test_sizes(self):
        self.assertIn("0 promises broken", self.stress("sizes", "--small", "--triangles", "20000", "--size", "97x55"))

    def test_reruns(self):
        self.assertRegex(self.stress("reruns", "--times", "1"), r"1 reruns of [1-9]\d+ rows: 0 of [1-9]\d+ values and [1-9]\d+ pictures differ")

    def test_what_differs_is_found(self):
        rows, pictures = {"r1": {"steps_mean": "3", "trace_ms_median": "1", "hiz.ms_median": "1"}}, {"a.png": b"1"}
        later = {"r1": {"steps_mean": "3", "trace_ms_median": "2", "hiz.ms_median": "2"}}
        for other, expected in (((later, pictures), []), (({"r1": {**later["r1"], "steps_mean": "4"}}, pictures), ["r1 steps_mean"]),
                                ((later, {"a.png": b"2", "b.png": b"1"}), ["a.png", "b.png"]), (({}, {}), ["rows r1"])):
            self.assertEqual(sweeps.differences((rows, pictures), other), expected)

    def test_mutations_change_code_alone(self):
        text = '#if a < b\nx = a < b; // a < b\ny = "a < b";\nz = min(p.x, 1.0);\n'
        found = [text[:at] + new + text[at + len(old):] for at, old, new in mutations.places(text)]
        self.assertEqual([one.splitlines()[1:] for one in found], [
            ["x = a <= b; // a < b", 'y = "a < b";', "z = min(p.x, 1.0);"], ["x = a < b; // a < b", 'y = "a < b";', "z = max(p.x, 1.0);"],
            ["x = a < b; // a < b", 'y = "a < b";', "z = min(p.y, 1.0);"]])


if __name__ == "__main__":
    main()
