"""experiments/doc_figures: what README.md and docs say was measured is in results/reference, and a changed row is noticed."""
import csv
import glob
import os
import re
import shutil
import subprocess

from support import SOURCE, Case, load_script, main

REFERENCE = os.path.join("results", "reference")
SCRIPTS = ("doc_figures", "default_settings", "trust", "ssrlab_results.py")
READ = ("results.csv", "environment.json", "sequence_summary.csv", "table.txt", "two_scenes.txt", "hard_cases.md", "hard_cases.txt", "gpu_tests.txt",
        "thousand.json")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def pages(root):
    return [os.path.join(root, "README.md")] + sorted(glob.glob(os.path.join(root, "docs", "**", "*.md"), recursive=True))


class Test(Case):
    def figures(self, root, *arguments, code=0):
        """What it printed; the script works on the tree that it lies in."""
        done = subprocess.run([os.path.join(root, "experiments", "doc_figures"), *arguments], capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def copied_tree(self):
        tree = self.path("tree")
        files = [os.path.join(SOURCE, "experiments", name) for name in SCRIPTS] + pages(SOURCE)
        files.append(os.path.join(SOURCE, "techniques", "hiz", "trace.glsl"))
        for name in READ:
            files += glob.glob(os.path.join(SOURCE, REFERENCE, "**", name), recursive=True)
        files += glob.glob(os.path.join(SOURCE, REFERENCE, "compiled", "*.json"))
        for path in files:
            target = os.path.join(tree, os.path.relpath(path, SOURCE))
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copy(path, target)
        return tree

    def replace(self, path, old, new):
        text = read(path)
        self.assertIn(old, text)
        self.write(path, text.replace(old, new, 1))

    def change(self, folder, column, value, **row):
        """One value in the one row of results.csv that has the others."""
        path = os.path.join(folder, "results.csv")
        with open(path, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        found = [one for one in rows if all(one[name] == wanted for name, wanted in row.items())]
        self.assertEqual(len(found), 1)
        found[0][column] = value
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def test_pages_agree_with_the_references(self):
        self.figures(SOURCE)

    def test_each_block_has_a_function_and_each_function_a_block(self):
        made = set(load_script("experiments", "doc_figures").BLOCKS)
        begun = [name for page in pages(SOURCE) for name in re.findall(r"<!-- experiments/doc_figures (\w+): begin -->", read(page))]
        ended = [name for page in pages(SOURCE) for name in re.findall(r"<!-- experiments/doc_figures (\w+): end -->", read(page))]
        self.assertEqual(sorted(begun), sorted(made))
        self.assertEqual(begun, ended)

    def test_a_changed_row_is_noticed_and_written(self):
        tree = self.copied_tree()
        self.figures(tree)
        before = {page: read(page) for page in pages(tree)}
        self.change(os.path.join(tree, REFERENCE, "lavapipe/surface_sizes"), "recall_1px", "0.1234", scene="engine", width="1920", surface="plane")
        self.assertRegex(self.figures(tree, code=1), r"\n\+\| `plane`, `stop` \|.*\| 12\.3 / ")
        self.assertEqual(before, {page: read(page) for page in pages(tree)})
        self.figures(tree, "--write")
        self.figures(tree)
        self.assertEqual([os.path.basename(page) for page in before if before[page] != read(page)], ["surfaces.md"])

    def test_a_changed_page_is_noticed(self):
        tree = self.copied_tree()
        page = os.path.join(tree, "docs", "surfaces.md")
        row = re.search(r"surface_quality: begin -->(?:\n\|.*){2}\n(.*)\n", read(page))[1]
        self.replace(page, row, row + "!")
        output = self.figures(tree, code=1)
        self.assertIn(f"\n-{row}!\n", output)
        self.assertIn(f"\n+{row}\n", output)

    def test_what_is_missing_or_unknown_is_named(self):
        tree = self.copied_tree()
        page = os.path.join(tree, "docs", "surfaces.md")
        whole = read(page)
        begin, end = (f"<!-- experiments/doc_figures surface_means: {word} -->" for word in ("begin", "end"))
        for old, new, message in ((begin, "", "surface_means ends, but nothing has begun"), (end, "", "begins before surface_means ends"),
                                  (begin, begin.replace("means", "dreams"), "surface_means ends, but surface_dreams has begun"),
                                  (whole, whole.replace("surface_means:", "surface_dreams:"), "no function makes the block surface_dreams"),
                                  (whole, whole.replace(begin, "").replace(end, ""), "surface_means: no page has the marks"),
                                  (whole, whole + whole, "is in docs/surfaces.md, too")):
            with self.subTest(message=message):
                self.write(page, whole)
                self.replace(page, old, new)
                self.assertIn(message, self.figures(tree, code=1))
        self.write(page, whole)
        shutil.rmtree(os.path.join(tree, REFERENCE, "lavapipe/surface_layers"))
        self.assertIn("results/reference/lavapipe/surface_layers/results.csv is missing", self.figures(tree, code=1))

    def test_a_sentence_that_no_longer_holds_is_named(self):
        figures = load_script("experiments", "doc_figures")
        figures.claim(True, "The sun shines")
        with self.assertRaisesRegex(figures.Failure, "has to be written anew: The sun shines"):
            figures.claim(False, "The sun shines")


if __name__ == "__main__":
    main()
