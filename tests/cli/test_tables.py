"""experiments/tables: the tables of results/reference are those of the committed rows, and a changed row is noticed."""
import os
import shutil
import subprocess

from support import SOURCE, Case, main

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
        with open(os.path.join(tree, REFERENCE, "figures.md"), encoding="utf-8") as file:
            self.assertIn("| 4321.5 |", file.read())
        # Two rows for one cell.
        with open(rows, "w", encoding="utf-8", newline="") as file:
            file.write("\r\n".join([head, first, first, *rest]))
        self.assertIn("Law of steps: 2 rows are", self.tables(tree, "--check", code=1))


if __name__ == "__main__":
    main()
