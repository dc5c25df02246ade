"""experiments/tables: the tables of results/reference are those of the committed rows, and a changed row is noticed."""
import os
import shutil
import subprocess
import sys
import tomllib

from support import SOURCE, Case, main, read

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
import plots.engines  # noqa: E402

REFERENCE = os.path.join("results", "reference")


class Test(Case):
    def tables(self, tree, *arguments, code=0):
        done = subprocess.run([os.path.join(tree, "experiments", "tables"), *arguments], capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stderr

    def copy(self):
        for folder in ("experiments", REFERENCE):
            shutil.copytree(os.path.join(SOURCE, folder), self.path(os.path.join("tree", folder)))
        return self.path("tree")

    def test_the_committed_tables_are_those_of_the_rows(self):
        self.tables(SOURCE, "--check")

    def test_a_changed_row_is_noticed(self):
        tree = self.copy()
        rows = os.path.join(tree, REFERENCE, "lavapipe/steps/results.csv")
        with open(rows, encoding="utf-8", newline="") as file:
            head, first, *rest = file.read().split("\r\n")
        values = dict(zip(head.split(","), first.split(",")))
        changed = first.replace(f",{values['fps']},", ",4321.5,")
        self.assertNotEqual(changed, first)
        with open(rows, "w", encoding="utf-8", newline="") as file:
            file.write("\r\n".join([head, changed, *rest]))
        self.assertRegex(self.tables(tree, "--check", code=1), "these differ from the rows: .*/figures.md; write them")
        self.tables(tree)
        self.assertIn("| 4321.5 |", read(tree, REFERENCE, "figures.md"))
        # Two rows for one cell.
        with open(rows, "w", encoding="utf-8", newline="") as file:
            file.write("\r\n".join([head, first, first, *rest]))
        self.assertIn("Law of steps: 2 rows are", self.tables(tree, "--check", code=1))

    def test_an_engine_is_shown_by_the_defaults_of_its_manifest(self):
        for engine in plots.engines.ENGINES:
            defaults = {name: one["default"] for name, one in tomllib.loads(read("techniques", "rivals", engine.technique, "technique.toml"))["parameters"].items()}
            for name in set(engine.default) & set(defaults):
                if "Lumen" not in engine.name:  # walks as FidelityFX does, with fewer steps
                    self.assertEqual(engine.default[name], defaults[name], f"{name} of {engine.name}")


if __name__ == "__main__":
    main()
