"""experiments/trust: its pages are those that are committed, and nothing that is missing is passed over."""
import os
import shutil
import subprocess

from support import SOURCE, Case, main

REFERENCE = os.path.join(SOURCE, "results", "reference")
PAGES = ("trust.md", "reliability.md")
READ = ("aa.json", "kills.json", "hostile.json", "fuzz.json", "thousand.json", "at_size.json", "reruns.json", "mutations.md", "lavapipe/campaign.md",
        "lavapipe/hard_cases.md", "lavapipe/resolution/results.csv", "lavapipe/resolution/environment.json")


class Test(Case):
    def trust(self, root, output, code=0):
        done = subprocess.run([os.path.join(root, "experiments", "trust"), "-o", output], capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def copied_tree(self):
        for name in READ:
            os.makedirs(os.path.dirname(self.path("tree/results/reference/" + name)), exist_ok=True)
            shutil.copy(os.path.join(REFERENCE, name), self.path("tree/results/reference/" + name))
        os.makedirs(self.path("tree/experiments"))
        shutil.copy(os.path.join(SOURCE, "experiments", "trust"), self.path("tree/experiments/trust"))
        return self.path("tree")

    def read(self, path):
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_pages_are_those_that_are_committed(self):
        self.trust(SOURCE, self.folder)
        for page in PAGES:
            self.assertEqual(self.read(self.path(page)), self.read(os.path.join(REFERENCE, page)), f"repeat: experiments/trust; {page}")

    def test_what_is_missing_is_named(self):
        tree = self.copied_tree()
        self.trust(tree, self.folder)
        for name in READ:
            os.rename(f"{tree}/results/reference/{name}", self.path("away"))
            self.assertIn(f"results/reference/{name} is missing", self.trust(tree, self.folder, code=1))
            os.rename(self.path("away"), f"{tree}/results/reference/{name}")

    def test_figures_come_from_the_files(self):
        tree = self.copied_tree()
        file = f"{tree}/results/reference/kills.json"
        self.write(file, self.read(file).replace('"lost": 0', '"lost": 7', 1))
        self.trust(tree, self.folder)
        self.assertIn("| lost | 7 |", self.read(self.path("reliability.md")))
        file = f"{tree}/results/reference/lavapipe/hard_cases.md"
        text = self.read(file)
        self.write(file, text.replace("| hold |", "| 3 broken |", 1))
        rows = text.count("| hold |")
        self.assertIn(f"but its table has {rows - 1} of {rows}", self.trust(tree, self.folder, code=1))


if __name__ == "__main__":
    main()
