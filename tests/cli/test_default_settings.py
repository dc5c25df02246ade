"""The defaults are what measures best: the committed rows of experiments/defaults.toml and the program's defaults agree."""
import glob
import json
import os
import subprocess
import tomllib

from support import SOURCE, Case, main, read

SCRIPT = os.path.join(SOURCE, "experiments/default_settings")
REFERENCE = os.path.join(SOURCE, "results/reference/lavapipe/defaults")


class Test(Case):
    def script(self, *arguments):
        return subprocess.run([SCRIPT, *arguments], capture_output=True, text=True)

    def test_no_change_beats_the_defaults(self):
        done = self.script(REFERENCE)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_recipe_is_measured(self):
        scenes = set(tomllib.loads(read("experiments/defaults.toml"))["scenes"])
        recipes = [os.path.basename(path)[:-5] for path in glob.glob(os.path.join(SOURCE, "experiments/scenes/*.toml"))]
        # Baking would take longer than measuring.
        shipped = {name for name in recipes if "[bake]" not in read(f"experiments/scenes/{name}.toml")}
        self.assertGreater(len(shipped), 8)
        self.assertEqual(shipped - scenes, set())
        self.assertEqual(scenes, {row["scene"] for row in self.rows(REFERENCE)})

    def test_the_first_run_has_the_defaults_of_the_program(self):
        settings = json.loads(self.ssrlab("list", "--json"))["settings"]
        with open(os.path.join(REFERENCE, "environment.json"), encoding="utf-8") as file:
            constants = json.load(file)["constants"]
        first = [constants | row for row in self.rows(REFERENCE) if row["run_number"] == "0"]
        checked = 0
        for setting in settings:
            # A setting may be newer than the rows.
            chosen = setting["table"] == "passes" or setting["name"] in ("surface", "behind")
            if not chosen or setting["name"] not in first[0]:
                continue
            for row in first:
                measured, expected = row[setting["name"]], setting["default"]
                with self.subTest(setting=setting["name"], scene=row["scene"]):
                    if "min" in setting:
                        self.assertEqual(float(measured), float(expected))
                    else:
                        self.assertEqual(measured, expected)
                checked += 1
        self.assertGreater(checked, 20 * len(first))

    def rows_folder(self, *rows):
        """Of scene, run number, gloss, RMSE and FLIP."""
        names = ["run_id", "scene", "view", "width", "height", "run_number", "technique", "gloss", "trace_ms_median", "outcome", "picture_rmse", "picture_flip"]
        lines = [",".join(names)]
        for i, (scene, number, gloss, rmse, flip) in enumerate(rows):
            lines.append(f"r{i},{scene},default,320,180,{number},hiz,{gloss},1,ok,{rmse},{flip}")
        self.write("rows/environment.json", json.dumps({"pass_parameters": "gloss"}))
        return os.path.dirname(self.write("rows/results.csv", "\n".join(lines) + "\n"))

    def test_means_are_geometric(self):
        done = self.script(self.rows_folder(("a", 0, "off", 0.1, 0.1), ("a", 1, "blur", 0.2, 0.1), ("b", 0, "off", 0.1, 0.2),
                                       ("b", 1, "blur", 0.1, 0.4)))
        self.assertEqual(done.returncode, 0, done.stderr)
        # RMSE 2 and 1, FLIP 1 and 2: each has the mean root 2.
        self.assertIn('| `gloss = "blur"` | 1.414 | 1.414 | 0 |', done.stdout)

    def test_a_better_change_is_an_error(self):
        done = self.script(self.rows_folder(("a", 0, "off", 0.1, 0.1), ("a", 1, "blur", 0.2, 0.09)))
        self.assertEqual(done.returncode, 1)
        self.assertIn('gloss = "blur"', done.stderr)

    def test_a_change_that_some_scenes_lack_is_refused(self):
        done = self.script(self.rows_folder(("a", 0, "off", 0.1, 0.1), ("a", 1, "blur", 0.2, 0.1), ("b", 0, "off", 0.1, 0.2)))
        self.assertEqual(done.returncode, 1)
        self.assertIn("expected one for each of 2 scenes", done.stderr)


if __name__ == "__main__":
    main()
