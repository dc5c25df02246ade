"""ssrlab fit: the choice is the best of the rows that it measured, its file repeats it, and each budget and objective pays its own columns."""
import json
import os
import re
import tomllib

from support import Case, main, read

PAGE = "docs/how-to/fit_to_a_budget.md"
SWEEP = """
scenes = ["builtin:stairs"]
sizes  = ["48x27"]
[passes]
pass_set = "shading"
[[techniques.hiz]]
surface   = ["plane_solid", "box"]
max_steps = [8, 11]
[techniques.dda]
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.write("sweep.toml", SWEEP)

    def fit(self, *arguments, **more):
        return self.ssrlab("fit", *arguments, "--sweep", "sweep.toml", "-o", "fit", "--quiet", **more)

    def settings(self, quality, cost):
        """{setting: (quality by picture, cost by picture)} of all rounds."""
        settings = {}
        for name in sorted(os.listdir(self.path("fit"))):
            if not os.path.isdir(self.path(f"fit/{name}")):
                continue
            for row in self.rows(f"fit/{name}"):
                self.assertEqual(row["outcome"], "ok", row)
                key = (row["technique"], row["surface"], row["max_steps"], row["thickness_m"])
                both = settings.setdefault(key, ([], []))
                both[0].append(float(row[quality]))
                both[1].append(sum(float(row[name]) for name in cost))
        return settings

    def test_the_choice_is_the_best_row_within_the_budget_and_can_be_repeated(self):
        said = self.fit("builtin:corridor", "--view", "steep", "--view", "down", "--budget-fetches", "7")
        tried = self.settings("f1_1px", ["fetches_mean"])
        pictures = len(next(iter(tried.values()))[0])
        self.assertEqual(pictures, 2)
        self.assertGreater(len(tried), 5)  # the search added some
        self.assertIn(f"{len(tried)} settings on {pictures} pictures", said)
        for budget in (7, 3.5, 14):
            within = [(-sum(quality) / pictures, max(cost), key) for key, (quality, cost) in tried.items() if max(cost) <= budget]
            line = re.search(rf"^{budget} fetches a ray +(.*)$", said, re.M)[1]
            if not within:
                self.assertEqual(line, "nothing is within it", said)
                continue
            f1, cost, (technique, surface, steps, _) = min(within)
            self.assertRegex(line, rf"^{-f1:.4f} +{cost:.4g} +{technique} surface={surface}( |$)", said)
            if budget == 7:
                chosen = (technique, surface, steps)
        self.ssrlab("run", "fit/choice.toml", "-o", "again", "--quiet")
        again = self.rows("again")
        self.assertEqual({(row["technique"], row["surface"], row["max_steps"]) for row in again}, {chosen})
        self.assertEqual(len(again), pictures)
        repeated = [float(row["f1_1px"]) for row in again], [float(row["fetches_mean"]) for row in again]
        self.assertEqual(repeated, next(value for key, value in tried.items() if key[:3] == chosen))
        # What was measured is not measured again, and the answer is the same.
        resumed = self.fit("builtin:corridor", "--view", "steep", "--view", "down", "--budget-fetches", "7", "--resume")
        self.assertIn(" 0 written now", resumed)
        self.assertEqual(resumed.split(" settings on ")[1], said.split(" settings on ")[1])

    def test_milliseconds_and_pictures_pay_their_own_columns(self):
        for objective, quality, cost in (("f1", "f1_1px", ["structures_ms_median", "trace_ms_median"]),
                                         ("flip", "picture_flip", ["structures_ms_median", "trace_ms_median", "rays_ms_median", "shade_ms_median"])):
            said = self.fit("builtin:corridor", "--view", "steep", "--budget-ms", "5000", "--objective", objective, "-t", "hiz",
                            "-p", "surface=plane", "-p", "max_steps=12")
            (quality, cost), = self.settings(quality, cost).values()
            line = re.search(r"^5000 ms +(\S+) +(\S+) +hiz$", said, re.M)
            self.assertEqual(line[1], f"{quality[0]:.4f}", said)
            self.assertAlmostEqual(float(line[2]) / cost[0], 1, delta=1e-3)
            os.rename(self.path("fit"), self.path(objective))

    def test_instructions_are_those_that_the_compiler_shows(self):
        self.need_amd()
        surface = ("-p", "surface=plane", "-p", "max_steps=12")
        said = self.fit("builtin:corridor", "--view", "steep", "--budget-instructions", "1e6", "--chip", "navi21", "-t", "hiz", *surface)
        row, = self.rows("fit/round_1")
        compiled = json.loads(self.ssrlab("--quiet", "shaders", "hiz", "--chip", "navi21", "--json", "-p", "pass_set=shading", *surface))
        trace, = [one for one in compiled["pipelines"] if one["shader"].startswith("trace/trace")]
        pyramid, = [one["instructions_a_pixel"] for one in compiled["frames"][0]["passes"] if one["pass"] == "depth_pyramid"]
        self.assertGreater(pyramid, 0)
        iterations = float(row["wave64_iterations_mean" if trace["lanes"] == 64 else "warp32_iterations_mean"])
        self.assertGreater(iterations, 1)
        expected = (pyramid * 48 * 27 / float(row["rays"]) + trace["statistics"]["Instructions"]
                    + trace["innermost_loop"]["instructions"] * (iterations - 1))
        line = re.search(r"^1e\+06 instructions a ray +(\S+) +(\S+) +hiz$", said, re.M)
        self.assertEqual(line[1], f"{float(row['f1_1px']):.4f}", said)
        self.assertAlmostEqual(float(line[2]) / expected, 1, delta=1e-3)
        # The sweep ran on the device of this environment, not on the chip.
        self.assertNotIn("NAVI21", self.text("fit/round_1/environment.json"))
        self.ssrlab("run", "fit/choice.toml", "-o", "again", "--quiet")

    def test_a_chip_that_cannot_be_asked(self):
        budget = ("builtin:stairs", "--sweep", "sweep.toml", "-o", "none", "--quiet", "--budget-instructions", "100")
        self.refused("fit", *budget, code=2, says=["--budget-instructions and --chip together"])
        self.refused("fit", *budget, "--budget-ms", "1", "--chip", "navi21", code=2, says=["one of them"])
        self.refused("fit", *budget[:-2], "--budget-ms", "1", "--chip", "navi21", code=2, says=["--budget-instructions and --chip together"])
        self.refused("fit", *budget, "--chip", "navi22", code=2, says=["did you mean 'navi21'?"])
        self.assertFalse(os.path.exists(self.path("none")))

    def test_the_page(self):
        page = read(PAGE)
        blocks = re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S)
        commands = [line for block in blocks for line in block.replace("\\\n", "").splitlines()]
        self.assertEqual(len(commands), 6)
        for command in commands:
            self.assertEqual(command.split()[0], "ssrlab")
            self.ssrlab(*command.split()[1:], "--quiet")
        self.assertIn('surface = "plane"', self.text("own/choice.toml"))
        rows = re.findall(r"^\| builtin:corridor \| (\w+) \| 12 \| hiz (?:\S+ )*\| (\S+) \| (\S+) \| (\S+) \| \S+ \|$", self.text("left_out/leave_one_out.md"), re.M)
        self.assertEqual([row[0] for row in rows], ["default", "down", "steep"])
        for _, fitted, best, lost in rows:
            self.assertAlmostEqual(float(best) - float(fitted), float(lost), delta=0.011)

    def test_the_choice_names_a_frame_by_its_absolute_path(self):
        self.ssrlab("gbuffer", "builtin:stairs", "--size", "48x27", "-o", "frame.exr")
        self.fit("frame.exr", "--budget-fetches", "50", "-t", "dda")
        choice = tomllib.loads(self.text("fit/choice.toml"))
        scene, = choice["scenes"]
        self.assertTrue(os.path.isabs(scene) and os.path.samefile(scene, self.path("frame.exr")), scene)
        self.assertEqual(list(choice["views"]), [scene])
        self.ssrlab("run", "fit/choice.toml", "-o", "again", "--quiet")

    def test_wrong_input_is_refused(self):
        self.ssrlab("gbuffer", "builtin:stairs", "--size", "32x18", "-o", "frame.exr")
        for arguments, says in ((("builtin:stairs",), "--budget-ms, --budget-fetches or --budget-instructions, one of them"),
                                (("builtin:stairs", "--budget-ms", "1", "--budget-fetches", "1"), "one of them"),
                                (("builtin:stares", "--budget-ms", "1"), "builtin:stares"),
                                (("builtin:stairs", "--budget-ms", "1", "--view", "above"), "above"),
                                (("builtin:stairs", "--budget-ms", "1", "--size", "big"), "--size: expected WIDTHxHEIGHT"),
                                (("builtin:stairs", "--budget-ms", "1", "-t", "hizz"), "did you mean 'hiz'?"),
                                (("builtin:stairs", "--budget-ms", "1", "-p", "surface=cube"), "-p surface=cube"),
                                (("builtin:stairs", "--budget-ms", "1", "-p", "steps=4"), "-p steps=4: unknown parameter of the sweep's techniques 'steps'"),
                                (("builtin:stairs", "--budget-ms", "1", "-p", "steps"), "expected name=value"),
                                (("frame.exr", "--budget-ms", "1", "--leave-one-out"), "--leave-one-out: expected a scene with two or more views"),
                                (("frame.exr", "--budget-ms", "1", "--objective", "flip"), "expected a frame with a 'reference'")):
            with self.subTest(arguments=arguments):
                self.refused("fit", *arguments, "--sweep", "sweep.toml", "-o", "none", "--quiet", code=2, says=[says])
                self.assertFalse(os.path.exists(self.path("none")))
        self.fit("builtin:stairs", "--budget-fetches", "0.5", "-t", "dda", code=2, says=["the cheapest, of dda, takes "])
        self.refused("fit", "builtin:stairs", "--budget-fetches", "9", "-o", "fit", code=2, says=["-o fit: expected a new or empty folder"])


if __name__ == "__main__":
    main()
