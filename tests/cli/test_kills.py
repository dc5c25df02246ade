"""tests/kills: a sweep that is killed again and again loses nothing, and a promise that is broken is found."""
import json
import os

from support import PROGRAM, Case, load_script, main

# Loses the first row whenever it starts, and then goes on as ssrlab.
FORGETFUL = f"""#!/bin/sh
for file in "$4"/results.csv; do [ -e "$file" ] && sed -i 2d "$file"; done
exec {PROGRAM} "$@"
"""


class Test(Case):
    def test_nothing_is_lost(self):
        earlier = {"kills": 9}
        self.write("kills.json", json.dumps({"runs": [earlier]}))
        self.script("kills", "--kills", "3", "--stops", "5", "-o", self.path("kills.json"))
        with open(self.path("kills.json"), encoding="utf-8") as file:
            kept, figures = json.load(file)["runs"]
        self.assertEqual(kept, earlier)
        self.assertEqual((figures["kills"], figures["stops"]), (3, 5))
        self.assertGreater(figures["rows_compared"], 0)
        self.assertEqual(set(figures["broken"].values()), {0})

    def test_a_program_that_forgets_is_found(self):
        program = self.write("forgetful", FORGETFUL)
        os.chmod(program, 0o755)
        text = self.script("kills", "--kills", "2", "--stops", "0", "--program", program, code=1)
        self.assertRegex(text, "lost: the row of run r[0-9a-f]+ was written and is (lost|another now)")

    def test_each_broken_promise_is_found(self):
        kills = load_script("tests", "kills")
        spec  = self.write("kills.toml", kills.SPEC)
        sweep = kills.Sweep(PROGRAM, self.folder, 0)
        self.ssrlab("run", spec, "-o", sweep.out)
        expected = {row["run_id"]: row for row in self.rows("out0")}
        pictures = sweep.pictures()
        self.assertGreater(len(pictures), len(expected))
        kills.check_finished(sweep, expected, pictures)
        rows, samples, passes = (sweep.file(name) for name in ("results.csv", "samples.csv", "passes.csv"))
        first = rows.split("\n")[1]
        steps = next(iter(expected.values()))["steps_mean"]
        for promise, name, text in (("lost", "results.csv", rows.replace(first + "\n", "")),
                                    ("doubled", "results.csv", rows + first + "\n"),
                                    ("torn", "results.csv", rows + first[:50]),
                                    ("torn", "results.csv", rows.replace(first, first[:50])),
                                    ("differ", "results.csv", rows.replace(first, first.replace(f",{steps},", ",7.77,"))),
                                    ("samples", "samples.csv", samples[:samples.rindex("\n", 0, -1) + 1]),
                                    ("samples", "samples.csv", samples + samples.split("\n", 1)[1]),
                                    ("passes", "passes.csv", passes + passes.split("\n", 1)[1]),
                                    ("pictures", "pictures/" + next(iter(pictures)), "another"),
                                    ("left over", "results.csv.tmp1", "")):
            self.write("out0/" + name, text)
            with self.assertRaises(kills.Broken) as found:
                kills.check_finished(sweep, expected, pictures)
            self.assertEqual(found.exception.promise, promise, found.exception)
            self.write("out0/results.csv", rows)
            self.write("out0/samples.csv", samples)
            self.write("out0/passes.csv", passes)
            with open(self.path("out0/pictures/" + next(iter(pictures))), "wb") as file:
                file.write(next(iter(pictures.values())))


if __name__ == "__main__":
    main()
