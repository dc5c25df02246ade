"""tests/hostile: files that lie are used or refused in one line that names them, and a program that breaks a promise is found."""
import json
import os

from support import PROGRAM, Case, load_script, main

# Falls over a picture without a byte, and is ssrlab otherwise.
FRAGILE = f"""#!/bin/sh
if [ -e image.png ] && [ ! -s image.png ]; then kill -SEGV $$; fi
exec {PROGRAM} "$@"
"""


class Test(Case):
    def test_one_of_each_rule(self):
        self.script("hostile", "--each", "1", "--only", "glb/", "-o", self.path("hostile.json"))
        with open(self.path("hostile.json"), encoding="utf-8") as file:
            figures = json.load(file)
        self.assertGreater(figures["by_kind"]["glb"]["refused"], 10)
        self.assertEqual(sum(figures["by_kind"]["glb"].values()), figures["files"])
        self.assertEqual(set(figures["broken"].values()), {0})

    def test_a_program_that_falls_is_found(self):
        program = self.write("fragile", FRAGILE)
        os.chmod(program, 0o755)
        text = self.script("hostile", "--only", "png/empty", "--program", program, code=1)
        self.assertIn("BROKEN (signal) png/empty/0", text)
        self.assertIn("repeat: tests/hostile --seed 1 --each 3 --only png/empty/0", text)

    def test_each_broken_promise_is_found(self):
        judge, names = load_script("tests", "hostile").broken_promise, ["a.png", "scene.gltf"]
        good = "ssrlab: a.png: cannot be decoded\n"
        self.assertIsNone(judge(0, "", names))
        self.assertIsNone(judge(1, good, names))
        self.assertIsNone(judge(2, "ssrlab: ./scene.gltf: no\n", names))
        for promise, code, said in (("time", None, ""), ("signal", -11, ""), ("signal", 134, ""), ("exit code", 3, good), ("not one line", 1, ""),
                                    ("not one line", 1, good + good), ("not one line", 1, good + "and more\n"),
                                    ("file not named", 1, "ssrlab: it cannot be read\n"), ("file not named", 1, "ssrlab: drawn.exr: no\n"),
                                    ("control characters", 0, "a\x1b[2Jb\n"), ("control characters", 1, "ssrlab: a.png: \x07\n")):
            self.assertEqual(judge(code, said, names), promise, (code, said))

    def test_the_seed_decides_every_damage(self):
        hostile = load_script("tests", "hostile")
        content = bytes(range(256)) * 4
        for rule, change in {**hostile.RANDOM, **hostile.ONCE, **hostile.TEXT}.items():
            once, again, other = (change(content, hostile.random.Random(seed)) for seed in (1, 1, 2))
            self.assertEqual(once, again, rule)
            self.assertNotEqual(once, content, rule)
            if rule in hostile.RANDOM:
                self.assertNotEqual(once, other, rule)


if __name__ == "__main__":
    main()
