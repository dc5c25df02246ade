"""What the report, its tables and summary.csv say, on results made up here: every answer can be worked out by hand."""
import math
import os
import re
import sys
import tomllib
from types import SimpleNamespace

from support import SOURCE, Case, load_script, main

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import plots.pairs  # noqa: E402
import plots.accuracy  # noqa: E402
import plots.folder  # noqa: E402
import plots.panels  # noqa: E402
import plots.pictures  # noqa: E402
import plots.ray  # noqa: E402
import plots.report  # noqa: E402
import plots.tables  # noqa: E402
import plots.verdict  # noqa: E402
import plots.results  # noqa: E402
from made_results import made_results, write_table  # noqa: E402
from matplotlib import pyplot as plt  # noqa: E402
from plots.data import Results, describe  # noqa: E402
from PIL import Image  # noqa: E402


def interval(low, high, pairs_=9):
    return plots.pairs.Ratio((low + high) / 2, low, high, pairs_)


class Test(Case):
    def near(self, found, expected):
        np.testing.assert_allclose(np.asarray(found, float), np.asarray(expected, float), rtol=1e-6, atol=1e-12)

    def samples(self, ms):
        """{run: milliseconds by round} of the trace."""
        write_table(self.path("out/samples.csv"), [{"run_id": run, "round": number, "pass": "trace", "ms": one} for run, times in ms.items() for number, one in enumerate(times)])

    def test_results_in_pandas(self):
        rows = [dict(technique="linear", space="pixels", jitter=True, steps=8, trace_ms_median=2, structures_ms_median="", frame=0),
                dict(technique="linear", space="metres", jitter=False, steps=16, trace_ms_median=3, frame=0),
                dict(technique="hiz", space="pixels", jitter=True, trace_ms_median=1, structures_ms_median=0.5, frame=3, view="NA"),
                dict(technique="hiz", outcome="failed", trace_ms_median="", message="no", frame=0)]
        for row in rows:
            row.update(thickness_m=0.1, psnr_visible_db=30, flips_per_million=2, wave64_iterations_mean=5, recall_1px=0.5, stopped_share=0.1, fps=3,
                       inverse_fps_s=1, error_median_px=1)
        rows[0]["kind"] = "only"  # of one run, so it does not vary
        made_results(self, rows, ["space", "jitter", "kind", "steps", "thickness_m"])
        loaded = plots.results.load(self.path("out"))
        self.assertEqual(list(loaded.run_id), ["r0", "r1", "r2"])
        self.assertEqual(list(loaded.series), ["linear, pixels, jitter", "linear, metres", "hiz"])
        self.assertEqual(plots.results.varying(loaded, loaded.attrs["inputs"]), ["space", "jitter", "steps"])
        self.assertEqual(list(loaded.frame_name), ["s, view default, 80×60", "s, view default, 80×60", "s, view NA, 80×60, frame 3"])
        self.near(loaded.cost_ms_median, [2, 3, 1.5])
        self.assertEqual(loaded.attrs["inputs"], ["space", "jitter", "kind", "steps"])
        self.assertEqual((loaded.attrs["constants"]["thickness_m"], loaded.attrs["constants"]["width"]), (0.1, 80))
        self.assertFalse({"thickness_m", "message", "width"} & set(loaded))
        self.assertIn("scene", loaded)
        self.assertNotIn("message", loaded.attrs["constants"])
        whole = plots.results.load(self.path("out"), keep_constants=True, failed=True)
        self.assertEqual((len(whole), whole.thickness_m.iloc[3], whole.message.iloc[3]), (4, 0.1, "no"))
        units = {"thickness_m": "m", "psnr_visible_db": "dB", "flips_per_million": "rays per million", "wave64_iterations_mean": "steps", "recall_1px": "share",
                 "stopped_share": "share", "fps": "", "inverse_fps_s": "s", "error_median_px": "px", "cost_ms_median": "ms", "trace_ms_ci_low": "ms", "trace_ms_ci_high": "ms",
                 "fetches_mean": "fetches", "rays": ""}
        self.assertEqual({name: whole.attrs["units"][name] for name in units}, units)
        made_results(self, [dict(row, screen_missed=0.1, steps_max=7) for row in rows], ["space", "jitter", "kind", "steps", "thickness_m"],
                     units="screen_missed=share; steps_max=steps; psnr_visible_db=dB")
        stated = plots.results.load(self.path("out"), keep_constants=True).attrs["units"]
        self.assertEqual([stated[name] for name in ("screen_missed", "steps_max", "psnr_visible_db", "thickness_m")], ["share", "steps", "dB", "m"])

    def test_damaged_results_are_named(self):
        made_results(self, [dict(technique="hiz")])
        whole = self.text("out/results.csv")
        for name, text in (("results.csv", whole[:30]), ("results.csv", ""), ("results.csv", whole + '"'), ("environment.json", "{"), ("environment.json", "")):
            with self.subTest(name=name, text=text):
                made_results(self, [dict(technique="hiz")])
                self.write(f"out/{name}", text)
                with self.assertRaisesRegex(plots.results.Unreadable, f"out/{name}: damaged: "):
                    plots.results.load(self.path("out"))

    def test_damage_names_row_and_column(self):
        for damage, message in ((lambda text: text.replace(",2,", ",fast,"), r"row 2 \(run r1\), column 'trace_ms_median': expected a number, got 'fast'"),
                                (lambda text: text.replace("r1,", "r1,,"), r"row 2 \(line 3\): expected \d+ fields, got \d+: one too many behind column "),
                                (lambda text: text.replace("r0,", "r0,,").replace("r1,", "r1,,"), r"row 1 \(line 2\): expected \d+ fields, got \d+"),
                                (lambda text: text[:text.index("r1,") + 9], r"row 2 \(line 3\): expected \d+ fields, got \d: column "),
                                (lambda text: text[:-1], "expected an end of line behind the last row"),
                                (lambda text: text[:text.index("r0,")], "holds no row")):
            made_results(self, [dict(technique="hiz", trace_ms_median=ms) for ms in (3, 2)])
            whole = self.text("out/results.csv")
            self.write("out/results.csv", damage(whole))
            self.assertNotEqual(self.text("out/results.csv"), whole)
            with self.subTest(message=message), self.assertRaisesRegex(plots.results.Unreadable, "out/results.csv: .*" + message):
                plots.results.load(self.path("out"))
        made_results(self, [dict(technique="hiz")])
        self.samples({"r0": [1, "fast"]})
        with self.assertRaisesRegex(plots.results.Unreadable, r"samples.csv: damaged: row 2 \(run r0\), column 'ms': expected a number, got 'fast'"):
            Results(self.path("out"))

    def verdict_rows(self):
        """linear reaches 0.99 with 20, 40 and 80 steps, at 80 with the best F1, at 40 within a point of it. march never does."""
        rows = [dict(technique="linear", steps=steps, trace_ms_median=ms, screen_recall_1px=found, f1_1px=f1)
                for steps, ms, found, f1 in ((10, 0.5, 0.9, 0.99), (20, 1, 0.992, 0.8), (40, 2, 0.991, 0.895), (80, 5, 0.999, 0.9))]
        rows += [dict(technique="march", steps=steps, trace_ms_median=ms, screen_recall_1px=found, f1_1px=0.5)
                 for steps, ms, found in ((10, 1, 0.5), (20, 9, 0.8), (40, 3, 0.7995))]
        rows[2].update(recall_1px=0.9, missed_not_in_depth=0.07, visible_displaced=0.02, missed_stopped=0.01, missed_facing_rule=0.0004, false_hits=0.05, false_self=0.015,
                       false_too_thick=0.03, false_wrong_surface=0.0004)
        rows.append(dict(technique="dda", trace_ms_median=2.2, screen_recall_1px=1, f1_1px=0.9))
        return rows

    def test_which_run_of_a_tracer_is_compared(self):
        rows = self.verdict_rows()
        made_results(self, rows, ["steps"])
        self.samples({"r2": [2, 2, 2, 2, 2, 2], "r7": [1.8, 1.9, 2, 2.2, 2.4, 2.6]})
        results = Results(self.path("out"))
        chosen = plots.verdict.picks(results)
        self.assertEqual(list(chosen.run_id), ["r2", "r7", "r6"])
        self.assertEqual(list(chosen.setting), ["linear, steps 40", "dda", "march, steps 40"])
        self.assertEqual(list(chosen.reached), [True, True, False])
        (_, text), = plots.verdict.verdicts(results, chosen)
        self.assertEqual(text, "linear (steps 40) is one of the cheapest tracers that find 99 % of what the depth buffer holds: 2 ms, "
                               "as fast as dda within the noise: 1.05 [0.9, 1.3] times. In brackets: 95 % intervals. "
                               "It misses 10 % of what the frame shows: 7 % are missed by exact tracers as well, 2 % hit another point, 1 % for other reasons. "
                               "5 % of its rays end in a false hit: 3 % behind a surface that is taken too thick, 1.5 % on the reflector itself, 0.5 % for other reasons.")
        (_, text), = plots.verdict.verdicts(results, chosen[~chosen.reached])
        self.assertEqual(text, "No tracer finds 99 % of what the depth buffer holds. The nearest is march (steps 40): 80 % in 3 ms.")
        results.targets = {"recall_1px": [0.5, 0.995]}
        self.assertEqual(plots.verdict.goal(results), ("screen_recall_1px", 0.99))
        results.targets = {"screen_recall_1px": [0.9, 0.95, 0.999]}
        self.assertEqual(plots.verdict.goal(results), ("screen_recall_1px", 0.95))

    def test_a_worse_surface_model_is_not_the_verdict(self):
        """Over boxes hiz finds all that the depth buffer holds, too, and sooner, but with a worse F1 than over planes. So do tracers that ran
        over boxes alone."""
        rows = [dict(technique=technique, surface=surface, trace_ms_median=ms, screen_recall_1px=1, f1_1px=f1)
                for technique, surface, ms, f1 in (("hiz", "box", 1, 0.8), ("hiz", "plane", 2, 0.9), ("linear", "box", 3, 0.8), ("mine", "box", 1.5, 0.8))]
        results = made_results(self, rows, ["surface"])
        chosen = plots.verdict.picks(results)
        self.assertEqual(list(chosen.run_id), ["r1", "r0", "r3", "r2"])
        (_, text), = plots.verdict.verdicts(results, chosen)
        self.assertTrue(text.startswith("hiz (plane) is the cheapest tracer that finds 99 % of what the depth buffer holds: 2 ms"), text)
        self.assertIn("2 ms, 1.5 times as fast as linear. hiz (box) takes 1 ms, but has an F1 of 80 % instead of 90 %.", text)
        self.assertEqual([row.technique for _, row in plots.verdict.ranking(results, chosen).iterrows()], ["hiz", "hiz", "mine", "linear"])

    def test_alternative_text_says_what_a_plot_shows(self):
        rows = [dict(technique="linear", steps=steps, trace_ms_median=ms, recall_1px=found, screen_recall_1px=found, precision_1px=found, f1_1px=found)
                for steps, ms, found in ((8, 1, 0.5), (16, 2, 0.6), (32, 3, 0.8), (64, 4, 0.9), (128, 5, 0.995))]
        results = made_results(self, rows, ["steps"])
        drawn, tables = plots.folder.draw(results, self.path("out/plots"))
        (_, verdict), = plots.report.write(results, drawn, tables)
        text = self.text("out/report.md")
        self.assertEqual(text.count(verdict), 1)
        self.assertIn("![1 − recall against trace + structures, ms and fetches per ray: linear is the first to reach 99 % recall, in 5 ms (s, view", text)
        self.assertIn("![1 − precision and 1 − F1 against trace + structures, ms: ", text)

    def test_the_ranking(self):
        """Over two frames: times by the geometric mean, shares by the mean. Who misses the target comes later, the nearer one first."""
        rows = [dict(technique=technique, view=view, trace_ms_median=ms, trace_ms_ci_low=ms / 2, trace_ms_ci_high=2 * ms, screen_recall_1px=found, recall_1px=found / 2,
                     precision_1px=0.5, f1_1px=0.4, false_hits=0.1, fetches_mean=10 * ms, flip_visible=0.2)
                for technique, times, recalls in (("slow", (4, 16), (1, 1)), ("quick", (1, 4), (0.99, 0.995)), ("far", (0.1, 0.1), (0.2, 0.2)),
                                                  ("near", (1, 1), (0.9, 0.8)), ("half", (1, 1), (0.3, 1)))
                for view, ms, found in zip(("a", "b"), times, recalls)]
        for row in rows[:2]:
            row["flip_visible"] = ""  # slow's alone
        results = made_results(self, rows)
        ranked = plots.verdict.ranking(results, plots.verdict.picks(results))
        self.assertEqual(list(ranked.label), ["quick", "slow", "half", "near", "far"])
        first = ranked.iloc[0]
        self.near([first.cost_ms_median, first.cost_ms_ci_low, first.cost_ms_ci_high], [2, 1, 4])
        self.near([first.screen_recall, first.recall, first.precision, first.f1, first.false_hits, first.flip, first.fetches],
                  [0.9925, 0.49625, 0.5, 0.4, 0.1, 0.2, 25])
        self.assertEqual(list(ranked.reached), [2, 2, 1, 0, 0])
        self.assertEqual(list(ranked.unreached), [0, 0, 1, 2, 2])
        shown = plots.tables.ranking_table(ranked)
        self.assertEqual([column["name"] for column in shown["columns"]],
                         ["rank", "tracer", "target reached", "recall", "precision", "F1", "false", "screen recall", "FLIP", "ms", "from", "to", "fetches"])
        self.assertEqual([cell["text"] for cell in shown["rows"][0]["cells"]],
                         ["1", "quick", "2 of 2", "49.6 %", "50 %", "40 %", "10 %", "99.2 %", "0.2", "2", "1", "4", "25"])
        self.assertEqual(shown["rows"][1]["cells"][8], {"text": "", "sort": "", "series": ""}, "what is not known is empty, and its column stays")
        self.assertEqual([row["best"] for row in shown["rows"]], [True] + [False] * 4)
        self.assertEqual([row["cells"][9]["sort"] for row in shown["rows"][:3]], ["2", "8", "1"])

    def test_means_over_frames(self):
        part = pd.DataFrame({"a": [1.0, 2, 6], "b": [1.0, 2, 32], "c": [1, np.nan, 3], "d": [0.0, 1, 2]})
        self.near([plots.verdict.mean_of(part, "a"), plots.verdict.geometric(part, "b"), plots.verdict.mean_of(part, "c")], [3, 4, 2])
        self.assertTrue(all(np.isnan(plots.verdict.geometric(part, name)) for name in ("c", "d", "none")), "unknown where one frame has none")

    def test_without_a_truth_all_settings_are_ranked_by_time(self):
        results = made_results(self, [dict(technique="linear", steps=steps, trace_ms_median=ms) for steps, ms in ((8, 3), (16, 1), (32, 2))], ["steps"])
        chosen = plots.verdict.picks(results)
        self.assertEqual(list(chosen.label), ["linear, steps 16", "linear, steps 32", "linear, steps 8"])
        ranked = plots.verdict.ranking(results, chosen)
        self.assertEqual(list(ranked.label), list(chosen.label))
        self.assertEqual(plots.verdict.verdicts(results, chosen), [])
        self.assertIn("No truth was computed", plots.report.ranking_text(results, chosen))

    def test_tables_of_a_frame(self):
        rows = [dict(technique="linear", steps=steps, trace_ms_median=ms, trace_ms_ci_low=ms / 2, trace_ms_ci_high=ms * 2, steps_mean=7, screen_recall_1px=found,
                     recall_1px=0.5, precision_1px=0.25, f1_1px=0.375, false_hits=0.0625, screen_precision_1px=0.9, flip_visible=0.21, picture_flip=0.11,
                     frame_ms_median=30, fps=33, visible_displaced=0.25,
                     missed_stepped_over=0.125, missed_stopped=0, missed_not_in_depth=0.125, error_scene_to_screen=0.5, wrong_rays=0.3, wrong_thin=0.2, wrong_other=0.1,
                     passes={"rays": (1.25, "9 pixels"), "cone": (None, "gloss = stochastic"), "trace": (2, ""), "blur": (0.5, "it is rough")})
                for steps, ms, found in ((16, 2, 1), (8, 1, 0.5))]
        rows[1]["picture_flip"] = ""
        results = made_results(self, rows, ["steps"])
        chosen = plots.verdict.picks(results)
        shown = plots.tables.row_table(results, results.rows, chosen)
        self.assertEqual([column["name"] for column in shown["columns"]],
                         ["tracer", "steps", "ms", "from", "to", "fetches", "steps", "recall", "precision", "F1", "false", "screen recall", "screen precision", "FLIP",
                          "picture FLIP", "frame ms", "fps", "repeats", "run"])
        self.assertEqual([[cell["text"] for cell in row["cells"]] for row in shown["rows"]],
                         [["linear", steps, ms, low, high, "1", "7", "50 %", "25 %", "37.5 %", "6.25 %", found, "90 %", "0.21", flip, "30", "33", "9", run]
                          for steps, ms, low, high, found, flip, run in (("8", "1", "0.5", "2", "50 %", "", "r1"), ("16", "2", "1", "4", "100 %", "0.11", "r0"))])
        self.assertEqual([row["best"] for row in shown["rows"]], [False, True])
        bar, = plots.tables.split_of(chosen)
        self.assertEqual([(part["kind"], part["width"], part["text"]) for part in bar["parts"]],
                         [("found", 50, "50 %"), ("displaced", 25, "25 %"), ("not-in-depth", 12.5, "12.5 %"), ("skipped-over", 12.5, "12.5 %")])
        errors = plots.tables.error_table(chosen)
        self.assertEqual([column["name"] for column in errors["columns"]], ["tracer", "scene → screen", "false", "wrong", "thin", "other"])
        self.assertEqual([cell["text"] for cell in errors["rows"][0]["cells"]], ["linear, steps 16", "50 %", "6.25 %", "30 %", "20 %", "10 %"])
        plan = plots.tables.plan_of(results, chosen)
        self.assertEqual([(one["name"], one["ms"], one["why"]) for one in plan["passes"]],
                         [("rays", "1.25", "9 pixels"), ("trace", "2", ""), ("blur", "0.5", "it is rough"), ("cone", "–", "gloss = stochastic")])
        self.assertIsNone(plan["bandwidth_gbps"])  # an old folder counts no bytes, and none was given
        results.passes = results.passes.assign(bytes_read_mean=40, bytes_written_mean=8)
        results.bandwidth_gbps = 100
        timed = plots.tables.plan_of(results, chosen)  # 80 x 60 pixels
        self.assertEqual([one["least_ms"] for one in timed["passes"]], ["0.0023", "0.0023", "0.0023", "–"])
        self.assertEqual([cell["sort"] for cell in plots.tables.plain_table([{"a": "2.5", "b": "x"}])["rows"][0]["cells"]], ["2.5", None])

    def test_failed_runs_and_their_commands(self):
        rows = [dict(technique="dda", frame=2, jitter_phases=5, steps=8, space="pixels", near=True, gloss="cone"),
                dict(technique="dda", outcome="failed", message="lost", frame=0), dict(technique="dda", outcome="invalid", frame=0), dict(technique="dda", outcome="skipped", frame=0)]
        results = made_results(self, rows, ["jitter_phases", "steps", "space", "near", "gloss"], pass_parameters="gloss",
                               command_line="bin/ssrlab --techniques 'my own' --quiet --device 1 run a.toml -o out")
        self.assertEqual(plots.report.again(results, "r1"), "bin/ssrlab --techniques 'my own' --device 1 run a.toml --only r1 -o again/r1")
        self.assertEqual(plots.report.ray_command(results, results.rows.iloc[0]),
                         "bin/ssrlab --techniques 'my own' --device 1 ray s --view default --size 80x60 -t dda --frame 2 --jitter 5 -p jitter_phases=5 -p steps=8 "
                         "-p space=pixels -p near=true")
        failed = plots.tables.failed_table(results, plots.report.again)
        self.assertEqual([[cell["text"] for cell in row["cells"]][:6] for row in failed["rows"]],
                         [["dda", "s", "default", "80×60", "failed", "lost"], ["dda", "s", "default", "80×60", "invalid", ""]])
        self.assertEqual(sorted(re.findall(r"\d \w+", plots.report.context(results, [], {})["counts"])), ["1 failed", "1 invalid", "1 ok", "1 skipped", "4 runs"])

    def test_what_the_page_shows(self):
        rows = [dict(technique="linear", steps=steps, trace_ms_median=ms, trace_ms_ci_low=ms, trace_ms_ci_high=ms, rays=1000, steps_mean=4, fetches_mean=6, recall_1px=0.75,
                     flip_visible=0.125, screen_recall_1px=0.5, screen_precision_1px=0.875, max_distance_m=math.inf, binary=binary, width=width)
                for steps, ms, binary, width in ((8, 1, 1, 80), (16, 2, 2, 80), (8, 1, 1, 1920), (16, 1, 1, 1920))]
        results = made_results(self, rows, ["steps", "binary", "max_distance_m"])
        data = plots.report.chart_data(results, plots.verdict.picks(results))
        run = data["runs"]["r1"]
        self.assertEqual(run["costs"], {"cost_ms_median": 2, "fetches_mean": 6, "steps_mean": 4, "fetches": 6})
        self.assertEqual(run["errors"], {"recall_1px": 0.25, "flip_visible": 0.125, "screen_recall_1px": 0.5, "screen_precision_1px": 0.125})
        self.assertEqual((run["floor"], run["size"], run["name"], run["time"]), (0.0005, [80, 60], "linear, steps 16, binary 2", "2 ms [2, 2]"))
        self.assertEqual(data["cloud"], {"linear": True})
        values = dict(zip(data["columns"], run["values"]))
        self.assertEqual((values["max_distance_m"], values["steps"]), ("inf", 16))
        self.assertEqual(dict(zip(data["columns"], data["units"]))["max_distance_m"], "m")
        self.assertEqual(plots.report.plain(np.float64(1.23456789)), 1.2346)
        line = made_results(self, [dict(row, binary=1) for row in rows], ["steps", "binary", "max_distance_m"])
        self.assertEqual(plots.report.chart_data(line, plots.verdict.picks(line))["cloud"], {"linear": False}, "one number alone varies")
        # Of each view the largest picture that is at most 1280 wide.
        chosen = pd.DataFrame([dict(scene="s", view="a", width=width, frame_title=f"a{width}") for width in (640, 1920, 1280)] +
                              [dict(scene="s", view="b", width=width, frame_title=f"b{width}") for width in (3840, 1920)])
        self.assertEqual(plots.report.with_pictures(results, chosen), {"a1280", "b3840"})

    def test_rows_of_the_summary(self):
        """stride is better the lower; FLIP too. Within half of what the best takes: 4 ms; each 1 % along the front costs (8 - 2) / 40."""
        rows = [dict(technique="linear", stride=stride, trace_ms_median=ms, recall_1px=found, precision_1px=0.5, f1_1px=0.6, screen_recall_1px=0.1, flip_visible=flip)
                for stride, ms, found, flip in ((1, 8, 0.9, 0.1), (2, 5, 0.45, 0.2), (4, 2, 0.5, 0.3))]
        rows.append(dict(technique="hiz", trace_ms_median=16, recall_1px=0.8995, flip_visible=0.25))
        results = made_results(self, rows, ["stride"], accuracy="linear.stride=lower", specification="[targets]\nrecall_1px = 0.9\nflip_visible = [0.2, 0.05]\n")
        table = plots.accuracy.summary(results)
        within = table[table.kind == "best_within_time"]
        self.near(within.time_budget_ms, [4, 4, 8, 8])
        self.assertEqual(list(zip(within.technique, within.run_id.fillna(""), within.setting)),
                         [("hiz", "", "no setting is fast enough"), ("linear", "r2", "linear, stride 4"), ("hiz", "", "no setting is fast enough"), ("linear", "r0", "linear, stride 1")])
        price = table[table.kind == "marginal_price"]
        self.assertEqual(list(price.run_id), ["r2", "r0"])
        self.near(price.price_ms_per_percent.iloc[1:], [6 / 40])
        cheapest = table[table.kind == "cheapest_for_target"]
        self.assertEqual(list(zip(cheapest.measure, cheapest.technique, cheapest.target, cheapest.setting, cheapest.value)),
                         [("recall_1px", "hiz", 0.9, "not reached", 0.8995), ("recall_1px", "linear", 0.9, "linear, stride 1", 0.9),
                          ("flip_visible", "hiz", 0.2, "not reached", 0.25), ("flip_visible", "linear", 0.2, "linear, stride 2", 0.2),
                          ("flip_visible", "hiz", 0.05, "not reached", 0.25), ("flip_visible", "linear", 0.05, "not reached", 0.1)])
        self.assertEqual(list(cheapest.missed_by.dropna()), ["r1", "r2"], "the next coarser stride")
        self.near(cheapest[["recall", "precision", "f1", "time_ms", "fetches_mean"]].iloc[1], [0.9, 0.5, 0.6, 8, 1])

    def test_a_bracket_begins_where_the_setting_before_may_be(self):
        """20 steps reach the target and take 4 times as long as hiz; 10 do not, and take 2 to 3 times as long."""
        rows = [dict(technique="hiz", trace_ms_median=1, recall_1px=1)]
        rows += [dict(technique="linear", steps=steps, trace_ms_median=ms, recall_1px=found) for steps, ms, found in ((10, 2.5, 0.9), (20, 4, 0.995))]
        made_results(self, rows, ["steps"], accuracy="linear.steps=higher", specification="[targets]\nrecall_1px = 0.99\n")
        self.samples({"r0": [1] * 6, "r1": [2, 2.2, 2.4, 2.6, 2.8, 3], "r2": [4] * 6})
        row = plots.accuracy.summary(Results(self.path("out"))).iloc[0]
        self.assertEqual((row.speedup, row.speedup_ci_low, row.speedup_ci_high, row.bracket, row.pairs), (4, 2, 4, "closed", 6))

    def test_the_front_holds_what_nothing_beats(self):
        rows = pd.DataFrame({"ms": [3, 1, 2, 2, 4], "error": [0.1, 0.5, 0.6, 0.3, 0.1]}, index=list("abcde"))
        self.assertEqual(list(plots.accuracy.pareto(rows, "ms", "error").index), ["b", "d", "a"])

    def test_pairs_of_many_rounds_are_medians_of_neighbours(self):
        """Of 36 ratios each block is two neighbours, 18 of them; at rank 5 of 18 the sign test keeps 95 %."""
        ratios = pd.Series(np.arange(36.0), index=range(36)) + 1
        self.near(plots.pairs.blocks_of(ratios.to_numpy()), np.arange(18) * 2 + 1.5)
        found = plots.pairs.paired_ratio(ratios[::-1], pd.Series(1.0, index=range(36)))
        self.near([found.median, found.low, found.high], [18.5, 9.5, 27.5])
        self.assertEqual(len(plots.pairs.blocks_of(np.ones(31))), 31)
        self.near(plots.pairs.blocks_of(np.tile([1.0, 2, 9], 16)), [2] * 16)
        # Critical values of the two-sided sign test at 5 %, plus one.
        for count, rank in ((6, 1), (8, 1), (9, 2), (11, 2), (12, 3), (15, 4), (17, 5), (20, 6), (25, 8), (30, 10)):
            found = plots.pairs.paired_ratio(ratios[:count], pd.Series(1.0, index=range(count)))
            self.assertEqual((found.low, found.high), (rank, count + 1 - rank), count)
        none = plots.pairs.paired_ratio(ratios, pd.Series([1.0], index=[99]))
        self.assertEqual((none.pairs, math.isnan(none.median)), (0, True))

    def test_frames_and_variants_are_told_apart(self):
        rows = [dict(technique="linear", space=space, frame=frame) for frame in (0, 3) for space in ("b", "a")]
        results = made_results(self, rows, ["space"])
        self.assertEqual([(title, name) for title, name, _ in results.pictures()],
                         [("s, view default, 80×60", "s_default_80x60_0"), ("s, view default, 80×60, frame 3", "s_default_80x60_3")])
        alone = [results.styles[f"linear, {space}"] for space in "ab"]
        self.assertNotEqual(alone[0]["color"], alone[1]["color"], "a technique against itself")
        several = made_results(self, [*rows, dict(technique="dda")], ["space"])
        a, b = (several.styles[f"linear, {space}"] for space in "ab")
        self.assertEqual((a["color"], a["linestyle"], b["color"], b["linestyle"]), (a["color"], "-", a["color"], "--"))
        self.assertNotEqual(a["marker"], b["marker"])
        self.assertEqual((several.chart_styles["linear, a"]["dash"], several.chart_styles["linear, b"]["dash"]), ([], [6, 4]))
        self.assertEqual(results.targets, {name: [0.9, 0.95, 0.99, 0.995] for name in ("recall_1px", "screen_recall_1px")}, "where none are stated")
        self.assertEqual([name for _, name, _ in made_results(self, rows[2:], ["space"]).pictures()], ["s_default_80x60"])

    def test_settings_are_named_where_they_vary(self):
        """Of a technique only what varies within it."""
        rows = [dict(technique="linear", space="a", steps=16, looks=looks, trace_ms_median=1) for looks in (1, 2)]
        rows += [dict(technique="linear", space="b", steps=8, looks=1, trace_ms_median=1), dict(technique="march", steps=4, looks=7, trace_ms_median=1)]
        results = made_results(self, rows, ["space", "steps", "looks"])
        named = [describe(results, row, results.rows) for _, row in results.rows.iterrows()]
        self.assertEqual(named, ["linear, a, steps 16, looks 1", "linear, a, steps 16, looks 2", "linear, b, steps 8, looks 1", "march"])
        self.assertEqual(results.swept(results.rows), ["steps", "looks"], "the one with most values first")

    def test_what_an_interval_shows(self):
        for low, high, said in ((1.01, 2, "faster"), (0.5, 0.99, "slower"), (0.5, 1.5, "no difference shown"), (1, 2, "no difference shown"), (np.nan, 2, "not known"),
                                (1.5, np.nan, "not known")):
            self.assertEqual(plots.accuracy.verdict(low, high), said, (low, high))

    def test_panels_show_what_their_experiment_names(self):
        row = pd.Series(dict(technique="linear", steps=16, jitter=True, width=80, recall_1px=0.5, precision_1px=np.nan, hit_share=0.25, picture="p/a.png", truth_picture="p/t.png"))
        self.assertEqual([plots.panels.picture_of({"show": show} if show else {}, row) for show in ("", "off", "truth", "causes")],
                         ["p/a.png", "p/t_off.png", "p/t.png", "p/a_causes.png"])
        figure = {"panels": [{"run_id": "a", "steps": 16, "jitter": True}, {"run_id": "b", "steps": 64, "jitter": True}], "measures": ["recall_1px", "precision_1px"]}
        self.assertEqual(plots.panels.caption(figure["panels"][0], figure, row), "steps 16\nrecall 0.500")
        self.assertEqual(plots.panels.caption({"steps": 16, "show": "agreement"}, figure, row), "agreement with the truth, steps 16\nrecall 0.500")
        self.assertEqual(plots.panels.caption({"steps": 16, "show": "off"}, figure, row), "no reflections")

    def test_pictures_of_the_report(self):
        """Each technique's best run comes before any variant; a technique's truth before all."""
        rows = [dict(technique="linear", space=space, trace_ms_median=ms, screen_recall_1px=1, picture=f"pictures/{space}.png", truth_picture="pictures/t.png", recall_1px=0.5,
                     false_hits=0.125, wrong_rays=0.25, picture_flip=0.0625, fetches_mean=3) for space, ms in (("b", 1), ("a", 2))]
        rows.append(dict(rows[0], technique="dda", space="", trace_ms_median=9, picture="pictures/dda.png"))
        rows.append(dict(rows[0], technique="hiz", space="", trace_ms_median=3, picture="pictures/lost.png"))
        results = made_results(self, rows, ["space"])
        os.makedirs(self.path("out/pictures"))
        for name in ("a", "b", "dda", "t", "t_off", "b_flip"):
            Image.new("RGB", (1280, 720), (200, 10, 10)).save(self.path(f"out/pictures/{name}.png"))
        chosen = plots.verdict.picks(results)
        shots, left, shape, pairs = plots.pictures.shots(results, chosen, results.rows)
        self.assertEqual([shot["name"] for shot in shots], ["Without reflections, and the truth", "linear, b", "dda", "linear, a"])
        self.assertEqual([[(image["name"], image["kind"]) for image in shot["images"]] for shot in shots[:2]],
                         [[("off", "picture"), ("truth", "picture")], [("linear, b", "picture"), ("linear, b", "FLIP")]])
        self.assertEqual([[one["caption"] for one in shot["images"]] for shot in shots[:2]], [["without reflections", "truth"], ["picture", "FLIP"]])
        self.assertEqual((left, shape, pairs), (1, "1280 / 720", [("best and truth", "linear, b", "truth")]))
        best = chosen.iloc[0]
        self.assertEqual([plots.pictures.finding(best, kind) for kind in plots.pictures.KINDS],
                         ["1 ms", "finds 50 % of what the frame shows, 12.5 % of the rays end in a false hit", "25 % of the rays are wrong",
                          "mean FLIP against the truth 0.0625", "3 fetches a ray"])

    def test_the_slider_compares_like_with_like(self):
        """The best run beside the truth where both show the environment; beside the coarsest one in any case, and first of all else."""
        rows = [dict(technique="linear", steps=steps, trace_ms_median=steps, screen_recall_1px=f1, f1_1px=f1, picture=f"pictures/{steps}.png",
                     truth_picture="pictures/t.png", pass_set="all", environment_fallback=True) for steps, f1 in ((8, 0.25), (16, 0.75), (32, 1))]
        os.makedirs(self.path("out/pictures"))
        for name in ("8", "16", "32", "t", "t_off"):
            Image.new("RGB", (64, 36)).save(self.path(f"out/pictures/{name}.png"))
        best, coarse = "linear, steps 32", "linear, steps 8"
        for less, expected in (({}, [("best and truth", best, "truth"), ("coarse and best", coarse, best)]),
                               ({"pass_set": "shading"}, [("coarse and best", coarse, best), ("off and best", "off", best)]),
                               ({"environment_fallback": False}, [("coarse and best", coarse, best), ("off and best", "off", best)])):
            results = made_results(self, [{**row, **less} for row in rows], ["steps", "pass_set", "environment_fallback"])
            shots, _, _, pairs = plots.pictures.shots(results, plots.verdict.picks(results), results.rows)
            self.assertEqual(pairs, expected)
            self.assertEqual([shot["name"] for shot in shots[1:]], [best, coarse])

    def ray(self):
        """4 px to the right and 3 down; a wall at 3 m in the second of two pixels."""
        walk = [dict(t_in=0.0, t_out=0.5, front_m=0, back_m=0, ray_in_m=1.0, ray_out_m=2.0), dict(t_in=0.5, t_out=1.0, front_m=3.0, back_m=None, ray_in_m=2.0, ray_out_m=4.0)]
        visits = [dict(t_in=0.0, t_out=0.5, level=1, then="skips", pixel=[12, 21]), dict(t_in=0.5, t_out=0.5, level=0, then="hit", pixel=[13, 22])]
        return dict(scene="s", pixel=[10, 20], origin_px_depth=[10, 20, 1], delta_px_depth=[4, 3, 1], walk=walk,
                    techniques=[dict(technique="hiz", status="hit", t=0.75, visits=visits), dict(technique="dda", status="left_screen", visits=[])],
                    screen_truth=dict(t=0.5), scene_truth={"class": "visible", "point_px": [12.8, 22.1]},
                    background=dict(first=[8, 16], rows=[[[1, 0, 0.25]] * 16] * 8))

    def test_a_ray_is_drawn_where_it_is(self):
        ray = self.ray()
        self.assertEqual(plots.ray.length_px(ray), 5)
        self.near(plots.ray.scene_truth_t(ray), 0.7)
        self.near([plots.ray.shown_t(ray), plots.ray.shown_t(dict(ray, techniques=[])), plots.ray.shown_t(dict(ray, techniques=[], screen_truth={}, scene_truth=None))],
                  [1, 1, 1])
        near_end = dict(ray, techniques=[], screen_truth={"t": 0.25}, scene_truth=None)
        self.near(plots.ray.shown_t(near_end), 1.4 * 0.25 + 2 / 5)
        for truth in ({"class": "sky", "point_px": [12, 21]}, {"class": "visible", "point_px": [9, 20]}, {"class": "visible", "point_px": [15, 23.75]}, {"class": "visible", "point_px": [None, 1]}):
            self.assertIsNone(plots.ray.scene_truth_t(dict(ray, scene_truth=truth)), truth)
        figure, (side, visits, screen) = plt.subplots(3, 1)
        self.addCleanup(plt.close, figure)
        plots.ray.draw_side(side, ray)
        lines = {line.get_label(): line.get_xydata().tolist() for line in side.get_lines()}
        self.near(lines["ray"], [[0, 1], [2.5, 2], [5, 4]])
        self.near(lines["hiz: hit"], [[3.75, 3]])
        self.assertEqual(lines["dda: left_screen"], [])
        self.near([lines["screen truth"][0][0], lines["scene truth"][0][0]], [2.5, 3.5])
        fill, = side.collections
        self.near(fill.get_datalim(side.transData).extents, [2.5, 3, 5, 1.1 * 4])
        self.near(side.get_ylim(), [4.4, 1 - 0.1 * 3.4])
        plots.ray.draw_visits(visits, ray, ray["techniques"][0], "#000000")
        skip, hit = visits.get_lines()
        self.near([skip.get_xdata(), skip.get_ydata()], [[0, 2.5], [1, 1]])
        self.near([*hit.get_xdata(), *hit.get_ydata()], [2.5, 2])
        self.assertEqual((skip.get_linewidth(), skip.get_alpha()), (3, 0.4))
        plots.ray.draw_screen(screen, ray)
        cells = [(*patch.get_xy(), patch.get_width(), patch.get_height()) for patch in screen.patches]
        self.assertEqual(cells, [(12, 20, 2, 2), (13, 22, 1, 1)])
        self.near(screen.get_lines()[0].get_xydata(), [[10, 20], [14, 23]])
        self.near(screen.get_lines()[-1].get_xydata(), [[13, 22.25]])
        self.near(screen.images[0].get_extent(), [8, 24, 24, 16])
        self.near(screen.images[0].get_array()[0, 0], [1, 0, 0.25 ** (1 / 2.2)])

    def test_judging_by_two_names(self):
        aa = load_script("experiments", "aa")
        self.assertEqual(aa.specification("s", "8x8").count("110"), 1)
        judged = [("same", interval(0.9, 1.1), 1), ("same", interval(1.01, 1.2), 1), ("same", interval(0.8, 0.98, 5), 1), ("same", interval(1, 1.5), 1),
                  ("slower", interval(1.05, 1.2), 1.1), ("slower", interval(0.9, 1.2), 1.2), ("slower", interval(0.9, 0.95), 1.4)]
        environment = {"commit": "c", "started": "now", "identity": {"device": "d"}}
        figures = aa.figures_of(judged, "aa", environment)
        expected = dict(pairs_of_frames=9, trials_of_two_names=4, false_alarms=2, interval_width=0.2236, trials_of_a_slowdown=3, found=1, found_with_the_wrong_sign=1,
                        slower_steps=1.1, slower_fetches=1.2, processor="unknown")
        self.assertEqual({name: figures[name] for name in expected}, expected)
        for alarms, found, holds in ((5, 95, True), (6, 95, False), (5, 94, False)):
            self.assertEqual(aa.holds(dict(figures, trials_of_two_names=100, false_alarms=alarms, trials_of_a_slowdown=100, found=found)), holds, (alarms, found))
        # dda takes 2 ms and its copy 3, and so on: the copy is the one above.
        steps = sorted({*aa.STEPS, *(round(1.1 * one) for one in aa.STEPS)})
        rows = [dict(technique=name + again, steps="") for name in ("dda", "hiz") for again in ("", "_again")]
        rows += [dict(technique="linear" + again, steps=one) for again in ("", "_again") for one in steps]
        for row in rows:
            row["fetches_mean"] = row["steps"] or 3
        made_results(self, rows, ["steps"])
        times = {f"r{i}": [(row["steps"] or 2) * (1.5 if row["technique"].endswith("_again") else 1)] * 6 for i, row in enumerate(rows)}
        self.samples(times)
        found = list(aa.trials(self.path("out")))
        self.assertEqual([kind for kind, _, _ in found], ["same", "same"] + ["same", "slower"] * len(aa.STEPS))
        self.near([ratio.low for kind, ratio, _ in found if kind == "same"], [1.5] * (2 + len(aa.STEPS)))
        slower = [round(1.1 * one) / one for one in aa.STEPS]
        self.near([[ratio.low, fetches] for kind, ratio, fetches in found if kind == "slower"], [[1.5 * one, one] for one in slower])

    def test_a_sweep_of_the_bench_adds_what_a_tracer_needs(self):
        bench = load_script("experiments", "bench")
        sweep = SimpleNamespace(samples={("tracer", name): pd.DataFrame({"ms": [one]}) for name, one in (("trace", 1.0), ("ray_packets", 2.0), ("depth_pyramid", 4.0), ("shade", 8.0))})
        self.near(bench.Sweep.times_ms(sweep, "tracer"), [3])
        self.near(bench.Sweep.times_ms(sweep, "tracer", bench.ON_DEPTH), [4])
        text = tomllib.loads(bench.specification("interior:piano", "8x8", ["nearest only"], 3, True))
        self.assertEqual((text["scenes"], text["views"], text["measure"]["min_repeats"], text["measure"]["max_repeats"]), (["interior"], ["piano"], 3, 3))
        self.assertEqual(text["techniques"], {"hiz_packets": [{"depth_pyramid": {"kind": "nearest"}}]})
        self.assertEqual(tomllib.loads(bench.specification("builtin:stairs", "8x8", ["plain"], 3, True))["views"], ["default"])


if __name__ == "__main__":
    main()
