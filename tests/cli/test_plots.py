"""What figures and tables show, read back from what was drawn. Results are made up, so that every answer can be worked out by hand."""
import os
import sys

from support import SOURCE, Case, main

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import plots.accuracy  # noqa: E402
import plots.effects  # noqa: E402
import plots.figures  # noqa: E402
import plots.panels  # noqa: E402
import plots.paper  # noqa: E402
import plots.sequences  # noqa: E402
import plots.sources  # noqa: E402
import plots.surfaces  # noqa: E402
from made_results import made_results, write_table  # noqa: E402
from matplotlib import pyplot as plt  # noqa: E402


def line_of(axis, label):
    """(x, y) of the one line whose label begins so."""
    line, = (one for one in axis.get_lines() if str(one.get_label()).startswith(label))
    return list(line.get_xdata()), list(line.get_ydata())


def segments_of(axis):
    """Ends of error bars along y, in the order in which they were drawn."""
    return [bar[:, 1].tolist() for container in axis.containers for lines in container[2] for bar in lines.get_segments() if len(bar)]


class Test(Case):
    def near(self, found, expected):
        np.testing.assert_allclose(np.asarray(found, float), np.asarray(expected, float), rtol=1e-6, atol=1e-12)

    def drawn(self, make, results):
        """({name: figure}, tables)"""
        tables = {}
        figures = dict(make(results, tables) or ())
        self.addCleanup(plt.close, "all")
        return figures, tables

    def asked_of_two_frames(self, *asked):
        """Two frames of 100 rays, 20 and 40 of them lost. Of each run: technique, sources, hand_on, and what its last source takes, in ms."""
        rows, lines = [], []
        for scene, lost in (("a", 20), ("b", 40)):
            for number, (technique, sources, hand_on, ms) in enumerate(asked):
                run = f"r{len(rows)}"
                rows.append(dict(scene=scene, run_number=number, technique=technique, sources=sources, hand_on=hand_on))
                for place, source in enumerate(sources.split(",")):
                    counts = {f"{kind}_{cls}": 0 for kind in ("handed", "right") for cls in ("visible", *plots.sources.LOST)}
                    if place == 0:
                        counts.update(handed_visible=100 - lost, handed_hidden=lost // 4, handed_facing_away=3 * lost // 4)
                    if source == "cube":
                        counts["right_hidden"] = lost // 4
                    recall = {"frame": 0.3 if technique == "linear" else 1 - lost / 100, "cube": 1 - 0.75 * lost / 100, "world": 1}[source]
                    lines.append(dict(counts, run_id=run, place=place, source=source, handed=100, meeting=100, points=10, right=8, certain_points=50,
                                      certain_right=49, draw_ms=0, trace_ms=30 if source == "frame" and technique == "hiz" else ms, shade_ms=0, megabytes=1, node_visits=10 * ms,
                                      all_meeting=100, all_recall=recall, all_precision=1, all_f1=recall))
        os.makedirs(self.path("out"))
        write_table(self.path("out/sources.csv"), lines)
        return made_results(self, rows, ["sources", "hand_on"])

    def test_the_ladder_of_sources(self):
        """World behind the frame takes 30 + 20 ms, alone 100 ms."""
        results = self.asked_of_two_frames(("hiz", "frame,cube", "lost", 60), ("hiz", "frame,world", "uncertain", 20), ("hiz", "world", "uncertain", 100))
        figure, = self.drawn(plots.sources.ladder, results)[0].values()
        self.assertEqual(figure.finding, "F1 over all rays: 70 % by the frame, 100.0 % by “+ world”, in 0.5 times the time of the world alone "
                         "(line: Pareto front; (lost): gets only rays without an answer yet)")
        steps, back, hybrids = plots.sources.tables_of(results).values()
        self.assertEqual([(step["sources"], step["ms"], step["recall, %"]) for step in steps],
                         [("frame", "30", "70.0"), ("+ world", "50", "100.0"), ("+ cube (lost)", "90", "77.5"), ("world alone", "100", "100.0")])
        self.near(figure.axes[0].get_lines()[0].get_xdata(), [30, 50])  # the front
        figure, = self.drawn(plots.sources.lost_by_class, results)[0].values()
        self.assertEqual(figure.finding, "The frame lacks 20 to 40 % of the points that rays meet; the largest part is facing away")
        self.assertEqual(self.drawn(plots.sources.brought_back, results)[0]["sources_brought_back"].finding,
                         "“cube” answers most of the lost rays rightly: 25 % in the mean")
        self.assertEqual([row["cube"] for row in back], ["25 (80)"] * 3)
        self.assertEqual([row["time / world alone"] for row in hybrids], ["0.50", "0.50"])

    def test_a_tracer_without_further_sources_is_a_step_of_the_ladder(self):
        results = self.asked_of_two_frames(("linear", "frame", "uncertain", 5), ("hiz", "frame,world", "uncertain", 20), ("hiz", "cube", "uncertain", 60),
                                           ("hiz", "world", "uncertain", 100))
        figure, = self.drawn(plots.sources.ladder, results)[0].values()
        self.assertEqual(figure.finding, "F1 over all rays: 30 % by linear, 70 % by hiz, 100.0 % by “+ world”, "
                         "in 0.5 times the time of the world alone (line: Pareto front)")
        steps, _ = plots.sources.tables_of(results).values()
        self.assertEqual([(step["sources"], step["ms"], step["recall, %"]) for step in steps],
                         [("linear", "5", "30.0"), ("hiz", "30", "70.0"), ("+ world", "50", "100.0"), ("cube", "60", "77.5"),
                          ("world alone", "100", "100.0")])

    def test_the_law_of_steps(self):
        """2 ms and 0.01 ms a step from 50 steps on. 0.15 m is nearer to 0.1 m than 0.06 m by its ratio; of looks the most count."""
        rows = []
        for thickness, looks, more_ms in ((0.15, 2, 0), (0.06, 2, 3), (5, 2, 3), (0.15, 1, 4)):
            for steps in (25, 50, 100, 500, 1000):
                ms = 2 + 0.01 * steps + more_ms if steps > 25 else 9
                rows.append(dict(technique="linear", thickness_m=thickness, looks=looks, steps=steps, trace_ms_median=ms, frame_ms_median=ms,
                                 frame_ms_ci_low=ms - 0.5, frame_ms_ci_high=ms + 0.25, fps=1000 / ms, inverse_fps_s=ms / 1000))
        rows.append(dict(technique="dda", thickness_m=0.15, frame_ms_median=50, frame_ms_ci_low=49, frame_ms_ci_high=51, fps=20, inverse_fps_s=0.05))
        rows = [dict(row, scene="animal_on_metal") for row in rows]
        figures, tables = self.drawn(plots.figures.law_of_steps, made_results(self, rows, ["thickness_m", "looks", "steps"]))
        (name, figure), = figures.items()
        self.assertEqual(name, "s0_fig11_fig12_fps_steps_animal_on_metal_default_80x60")
        self.assertEqual(tables, {"Law of steps: frame time = slope · steps + intercept, from 50 steps up": [
            {"frame": "animal_on_metal, view default, 80×60", "series": "linear", "slope, ms per step": "0.01", "intercept, ms": "2", "R²": "1.0000"}]})
        left, right = figure.axes
        steps, ms = [25, 50, 100, 500, 1000], [9, 2.5, 3, 7, 12]
        self.near(line_of(left, "linear"), [steps, [1000 / one for one in ms]])
        self.near(line_of(left, "dda")[1], [20, 20])
        self.near(line_of(right, "dda")[1], [50, 50])
        self.near(line_of(right, "linear: fit"), [[50, 1000], [2.5, 12]])
        self.near(segments_of(right), [[one - 0.5, one + 0.25] for one in ms])
        self.near(right.containers[0][0].get_ydata(), ms)
        # The report's own frame rates, scaled so that its 31 at 500 steps are the 1000 / 7 here.
        steps, fps = line_of(left, "OpenGL report")
        self.near([steps, fps], [[25, 50, 100, 250, 500, 1000, 2500], np.array([120, 118, 91, 53, 31, 18, 9]) * 1000 / 7 / 31])
        self.near(line_of(right, "OpenGL report")[1][0], 31 * 7 / 120)
        self.assertEqual(figure.finding, "From 50 steps on, each step of linear adds 0.01 ms (R² 1.0000); level lines: tracers without steps "
                         "(animal_on_metal, view default, 80×60)")
        self.assertEqual({text.get_text().split(",")[0] for text in left.texts}, {"linear", "dda", "OpenGL report"})

    def test_a_fit_says_how_well_it_fits(self):
        """Through (0, 0), (1, 3), (2, 3): slope 1.5, intercept 0.5; of 6 squares around the mean 2, 1.5 are left."""
        self.near(plots.figures.fit_line(np.array([0.0, 1, 2]), np.array([0.0, 3, 3])), [1.5, 0.5, 0.75])

    def thickness(self):
        """Half of the rays have a visible truth: misses are 25, 10, 5, 2.5 % of the rays at 40 steps, and false hits 1, 2, 10, 20 %."""
        rows = []
        for steps, worse in ((10, 0.2), (20, 0.1), (40, 0)):
            for thickness, recall, false in ((0.05, 0.5, 0.01), (0.1, 0.8, 0.02), (0.2, 0.9, 0.1), (0.4, 0.95, 0.2)):
                rows.append(dict(technique="linear", thickness_m=thickness, steps=steps, recall_1px=recall - worse, false_hits=false + worse,
                                 truth_visible=0.5, screen_missed=0, trace_ms_median=steps * thickness))
        return made_results(self, rows, ["thickness_m", "steps"])

    def test_the_best_thickness(self):
        figures, tables = self.drawn(plots.figures.thickness_curves, self.thickness())
        (_, figure), = figures.items()
        self.assertEqual(tables, {plots.figures.BEST_THICKNESS: [
            {"frame": "s, view default, 80×60", "series": "linear, 40 steps", "thickness, m": "0.1", "missed, % of rays": "10.00", "false, % of rays": "2.00"}]})
        axis, = figure.axes
        self.near(line_of(axis, "linear, 40 steps"), [[0.05, 0.1, 0.2, 0.4], [26, 12, 15, 22.5]])
        circled = axis.get_lines()[1]
        self.near([circled.get_xdata(), circled.get_ydata()], [[0.1], [12]])
        self.assertIn("Fewest rays are wrong at a thickness of 0.1 m: 12.0 % (linear, 40 steps)", figure.finding)

    def test_maps_of_thickness_and_steps(self):
        figures, _ = self.drawn(plots.figures.thickness_maps, self.thickness())
        (_, figure), = figures.items()
        recall, false, time = (axis.images[0] for axis in figure.axes)
        worse, found = np.array([0.2, 0.1, 0]), np.array([[0.5], [0.8], [0.9], [0.95]])
        self.near(recall.get_array(), 100 * (found - worse))
        self.near(false.get_array(), 100 * (np.array([[0.01], [0.02], [0.1], [0.2]]) + worse))
        self.near(time.get_array(), np.outer([0.05, 0.1, 0.2, 0.4], [10, 20, 40]))
        self.near([recall.get_clim(), false.get_clim(), time.get_clim()], [[0, 100], [0, 40], [0, 16]])
        self.assertEqual([figure.axes[2].get_xticklabels()[0].get_text(), figure.axes[0].get_yticklabels()[0].get_text()], ["10", "0.05"])
        self.assertEqual([axis.texts[1].get_text() for axis in figure.axes], ["40", "11", "1"])
        self.assertIn("linear finds most with 40 steps of 0.4 m, and has the fewest false hits with 40 steps of 0.05 m", figure.finding)

    def test_comparison_of_techniques(self):
        rows = [dict(scene=scene, technique=technique, trace_ms_median=ms, trace_ms_ci_low=ms - 0.5, trace_ms_ci_high=ms + 1, structures_ms_median=own,
                     fetches_mean=10 * ms)
                for scene, technique, ms, own in (("a", "dda", 4, 0), ("a", "hiz", 1, 2), ("b", "dda", 2, 0), ("b", "hiz", 3, 0.5))]
        del rows[3]["trace_ms_ci_low"]
        figures, _ = self.drawn(plots.figures.comparison, made_results(self, rows))
        figure = figures["compare_default_80x60"]
        time, fetches = figure.axes[:2]
        self.assertEqual([label.get_text() for label in time.get_yticklabels()], ["a", "b"])
        marks = [{one.get_label(): dict(zip(one[0].get_ydata(), one[0].get_xdata())) for one in axis.containers} for axis in (time, fetches)]
        self.assertEqual(marks, [{"dda": {0: 4, 1: 2}, "hiz": {0: 3, 1: 3.5}}, {"dda": {0: 40, 1: 20}, "hiz": {0: 10, 1: 30}}])
        ends = {one.get_label(): [bar[:, 0].tolist() for bar in one[2][0].get_segments() if len(bar) > 1] for one in time.containers}
        self.assertEqual(ends, {"dda": [[1.5, 3], [3.5, 5]], "hiz": [[2.5, 4]]}, "none where the interval is not known")
        hollow = next(line for line in time.get_lines() if line.get_markerfacecolor() == "white" and len(line.get_xdata()))
        self.near(hollow.get_xydata(), [[3.5, 1]])
        self.assertEqual(figure.finding.split(" (")[0], "In none of 2 scenes is one faster than all others by more than the intervals")

    def test_a_title_ranks_only_what_its_intervals_tell_apart(self):
        def titles(make, swept=(), **more):
            (_, figure), *_ = self.drawn(make, made_results(self, [dict(row, **more) for row in rows], swept))[0].items()
            return figure.finding.split(" (")[0]
        def times(**ends):
            return [dict(technique=name, trace_ms_median=ms, trace_ms_ci_low=low, trace_ms_ci_high=high) for name, (low, ms, high) in ends.items()]
        for rows, title in ((times(box=(8, 9, 10), plane=(9.5, 12, 65)), "The times do not differ by more than their intervals"),
                            (times(box=(8, 9, 10), plane=(9.5, 12, 65), dda=(17, 18, 19)),
                             "The times of box and plane do not differ by more than their intervals; dda takes 2 times as long as box"),
                            (times(box=(8, 9, 10), dda=(17, 18, 19)), "box is the fastest; dda takes 2 times as long"),
                            (times(box=("", 9, ""), dda=("", 18, "")), "box is the fastest; dda takes 2 times as long; not all intervals are known")):
            self.assertEqual(titles(plots.figures.comparison), title)
        rows = [dict(row, scene=scene) for scene in "ab" for row in times(box=(8, 9, 10), dda=(17, 18, 19))]
        self.assertEqual(titles(plots.figures.comparison), "box is the fastest in 2 of 2 scenes by more than the intervals")
        rows = [dict(row, steps=steps, recall_1px=recall) for steps, recall in ((1, 0.5), (2, 0.6), (3, 0.99))
                for row in times(linear=(8 + steps, 9 + steps, 10 + steps), march=(8 + steps, 9.1 + steps, 13 + steps))]
        self.assertEqual(titles(plots.accuracy.accuracy_curves, ["steps"]), "linear and march reach 99 % recall in times that do not differ by more than their intervals")
        rows = [dict(technique="linear", steps=steps, frame_ms_median=ms, frame_ms_ci_low=5, frame_ms_ci_high=12, fps=1000 / ms, inverse_fps_s=ms / 1000)
                for steps, ms in ((8, 9), (16, 8), (32, 7), (64, 6))]
        self.assertEqual(titles(plots.figures.law_of_steps, ["steps"]), "From 8 to 64 steps the times of linear do not differ by more than their intervals")
        rows = [dict(row, frame_ms_ci_low=row["frame_ms_median"], frame_ms_ci_high=row["frame_ms_median"]) for row in rows]
        self.assertEqual(titles(plots.figures.law_of_steps, ["steps"]), "From 8 to 64 steps linear goes from 9 to 6 ms")
        rows = [dict(technique="dda", gloss=gloss, run_number=number, picture_rmse=error, frame_ms_median=ms, frame_ms_ci_low=ms - 1, frame_ms_ci_high=ms + 1)
                for number, (gloss, error, ms) in enumerate((("stochastic", 0.2, 9), ("cone", 0.1, 13)))]
        figure, = self.drawn(plots.effects.trades, made_results(self, rows, ["gloss"], pass_parameters="gloss"))[0].values()
        self.assertIn("gloss cone takes picture_rmse from 0.2000 to 0.1000 for 4.00 ms", figure.finding)

    def growing(self):
        """Cost as the square root of the pixels, fetches as their fourth root; half of the pixels are rays."""
        rows = []
        for side in (100, 200, 400):
            rows.append(dict(technique="hiz", width=2 * side, height=side // 2, trace_ms_median=side / 100 - 0.25, structures_ms_median=0.25,
                             fetches_mean=4 * side ** 0.5, rays=side * side // 2))
        return made_results(self, rows)

    def test_growth_with_the_picture(self):
        results = self.growing()
        figures, tables = self.drawn(plots.figures.growth, results)
        (_, figure), = figures.items()
        rows, = tables.values()
        self.assertEqual([(row["of"], row["exponent"]) for row in rows], [("time per ray, ns", "-0.500"), ("fetches per ray", "0.250")])
        time, fetches = figure.axes
        self.near(line_of(time, "hiz"), [[1e4, 4e4, 16e4], [1e6 / 5e3, 2e6 / 20e3, 4e6 / 80e3]])
        self.near(line_of(fetches, "hiz")[1], [40, 40 * 2 ** 0.5, 80])
        self.assertEqual([axis.texts[0].get_text() for axis in (time, fetches)], ["hiz, -0.50", "hiz, +0.25"])
        self.assertIn("From 50p to 200p a ray of hiz fetches 2 times as much", figure.finding)

    def test_what_passes_cost_and_remove(self):
        common = dict(technique="dda", gloss="stochastic", filter_3x3=True, frame_ms_ci_low=8.5)
        rows = [dict(common, run_number=0, frame_ms_median=10, frame_ms_ci_high=11, picture_rmse=0.2, picture_visible_border_rmse=0.3),
                dict(common, run_number=1, gloss="cone", frame_ms_median=12.5, frame_ms_ci_high=13.5, picture_rmse=0.15, picture_visible_border_rmse=0.1),
                dict(common, run_number=2, filter_3x3=False, frame_ms_median=9, picture_rmse=0.25, picture_visible_border_rmse=0.4)]
        results = made_results(self, rows[::-1], ["gloss", "filter_3x3"], pass_parameters="gloss filter_3x3")
        figures, tables = self.drawn(plots.effects.trades, results)
        (name, figure), = figures.items()
        lines, = tables.values()
        self.assertEqual([tuple(line.values())[1:] for line in lines], [("gloss cone", "2.50", "+0.0500", "+0.2000"), ("no filter_3x3", "-1.00", "-0.0500", "-0.1000")])
        self.assertIn("gloss cone takes picture_rmse from 0.2000 to 0.1500 in a time that does not differ by more than the intervals", figure.finding)
        removed, added = figure.axes
        self.assertEqual([label.get_text() for label in removed.get_yticklabels()], ["gloss cone", "no filter_3x3"])
        self.near(line_of(removed, "all that reflects")[0], [0.05, -0.05])
        self.near(line_of(removed, "at borders of materials")[0], [0.2, -0.1])
        self.near(added.containers[0][0].get_xdata(), [2.5, -1])
        self.near(added.containers[0][2][0].get_segments()[0][:, 0], [12.5 - 10 - 4, 3.5])
        self.near(added.get_lines()[1].get_xdata(), [-1])  # hollow

    def test_names_beside_points_keep_their_order_and_their_room(self):
        places = plots.paper.spread(np.array([0.0, 1, 2]), np.array([0.5, 0.5, 0.9]), 0.2, 0, 1)
        self.near(places, [0.7, 0.5, 0.9])
        self.near(plots.paper.spread(np.array([0.0, 1]), np.array([0.95, 1.0]), 0.2, 0, 1), [0.8, 1])
        self.near(plots.paper.spread(np.zeros(5), np.array([1.0, 0.9, 0.8, 0.7, 0.1]), 0.1, 0, 1), [1, 0.9, 0.8, 0.7, 0.1])
        self.near(plots.paper.spread(np.arange(5.0), np.ones(5), 0.1, 0, 1), [1, 0.9, 0.8, 0.7, 0.6])
        self.near(plots.paper.spread(np.arange(3.0), np.zeros(3), 0.9, 0, 1), [1, 0.5, 0])  # no more room than there is

    def test_curves_of_accuracy(self):
        """Of 100 rays half a one is the least error that can be drawn."""
        rows = [dict(technique="linear", steps=steps, trace_ms_median=ms, trace_ms_ci_low=ms - 0.5, trace_ms_ci_high=ms + 1, structures_ms_median=1, rays=100,
                     fetches_mean=10 * ms, recall_1px=recall, precision_1px=0.9, f1_1px=0.8)
                for steps, ms, recall in ((10, 1, 0.5), (20, 2, 0.9), (40, 4, 0.8), (80, 8, 0.99), (160, 16, 1))]
        figures, _ = self.drawn(plots.accuracy.accuracy_curves, made_results(self, rows, ["steps"]))
        self.assertEqual([name.removesuffix("_s_default_80x60") for name in figures], ["accuracy_recall_1px", "accuracy_precision_f1"])
        figure = figures["accuracy_recall_1px_s_default_80x60"]
        time, fetches = figure.axes
        self.near(line_of(time, "linear"), [[2, 3, 9, 17], [0.5, 0.1, 0.01, 0.005]])  # the front
        self.near(time.get_lines()[0].get_xydata(), np.transpose([[2, 3, 5, 9, 17], [0.5, 0.1, 0.2, 0.01, 0.005]]))
        self.near([bar[:, 0] for bar in time.containers[0][2][0].get_segments()], [[1.5, 3], [2.5, 4], [8.5, 10], [16.5, 18]])
        self.near(line_of(fetches, "linear"), [[10, 20, 80, 160], [0.5, 0.1, 0.01, 0.005]])
        self.assertEqual([line.get_ydata()[0] for line in time.get_lines() if line.get_linestyle() == ":"], [0.005])
        self.assertIn("linear is the first to reach 99 % recall, in 9 ms (s, view", figure.finding)
        self.assertEqual([text.get_text() for text in time.texts], ["linear"])
        precision, f1 = figures["accuracy_precision_f1_s_default_80x60"].axes
        self.near(line_of(precision, "linear")[1] + line_of(f1, "linear")[1], [0.1, 0.2])
        self.assertIn("80 % F1", figures["accuracy_precision_f1_s_default_80x60"].finding)

    def test_one_line_a_technique(self):
        rows = [dict(technique=technique, space=space, steps=steps, trace_ms_median=ms, recall_1px=recall, rays=100)
                for technique, space, steps, ms, recall in (("linear", "view", 8, 1, 0.3), ("linear", "view", 16, 4, 0.5), ("linear", "pixels", 8, 2, 0.45),
                                                           ("linear", "pixels", 16, 3, 0.7), ("dda", "", 8, 6, 0.92))]
        figures, _ = self.drawn(plots.accuracy.accuracy_curves, made_results(self, rows, ["space", "steps"]))
        figure, = figures.values()
        self.near(line_of(figure.axes[0], "linear"), [[1, 2, 3], [0.7, 0.55, 0.3]])
        self.assertIn("dda is the first to reach 90 % recall, in 6 ms; no other does", figure.finding)
        rows = [dict(row, surface=surface) for row in rows for surface in (("box", "plane") if row["technique"] == "dda" else ("box",))]
        figure, = self.drawn(plots.accuracy.accuracy_curves, made_results(self, rows, ["surface", "space", "steps"]))[0].values()
        self.assertEqual({text.get_text() for text in figure.axes[0].texts}, {"linear", "dda, box", "dda, plane"})
        self.assertEqual({line.get_label(): line.get_linestyle() for line in figure.axes[0].get_lines() if not line.get_label().startswith("_")},
                         {"linear": "-", "dda, box": "-", "dda, plane": "--"})

    def test_many_names_make_a_panel_higher(self):
        self.assertEqual(plots.paper.height_beside(["hiz"], 1.9), 1.9)
        self.assertGreater(plots.paper.height_beside(["strided_direction, plane_infinite"] * 18, 1.9), 18 * 2 * 6 / 72)  # two lines of 6 pt each

    MODELS = (("plane", "stop", 0.8, 0.5), ("box", "stop", 0.6, 0), ("box", "hit", 0.5, 0))

    def surfaces(self, thicknesses=(0.1,), layers=(1,), models=MODELS):
        """A box finds more the thicker it is, and more that is false. F1 is best at 0.2 m."""
        rows = []
        for scene, better in (("a_hall", 0), ("b_hall", 0.1)):
            for surface, behind, most, solid_ms in models:
                for thickness in thicknesses:
                    own = 0.1 if surface == "plane" else thickness  # a plane needs none
                    for layer in layers:
                        f1 = most + better + 0.05 * (layer - 1) - abs(thickness - 0.2)
                        rows.append(dict(scene=scene, technique="hiz", surface=surface, behind=behind, thickness_m=thickness, layers=layer,
                                         recall_1px=most + own / 10, precision_1px=0.9 - own, f1_1px=f1, hidden_too_f1_1px=f1 - 0.1,
                                         hidden_too_recall_1px=0.5, trace_ms_median=2 + better, structures_ms_median=0.75,
                                         passes={"layers": (layer - 1, "") if layer > 1 else (None, ""), "solid_backs": (solid_ms, ""), "trace": (2, "")}))
        return made_results(self, rows, ["surface", "behind", "thickness_m", "layers"])

    def test_surfaces_are_compared_by_the_best_tracer(self):
        rows = [dict(scene="a_hall", technique=technique, surface=surface, behind="stop", thickness_m=0.1, recall_1px=f1, precision_1px=f1,
                     f1_1px=f1, trace_ms_median=2, structures_ms_median=1, passes={"trace": (2, "")})
                for technique, f1 in (("linear", 0.2), ("hiz", 0.9), ("dda", 0.8)) for surface in ("box", "plane")]
        results = made_results(self, rows, ["surface", "behind", "thickness_m"])
        self.assertEqual(set(plots.surfaces.one_tracer(results.rows).technique), {"hiz"})

    def test_precision_against_recall(self):
        results = self.surfaces(thicknesses=(0.4, 0.1, 0.2))
        figures, _ = self.drawn(plots.surfaces.precision_against_recall, results)
        figure = figures["surfaces_precision_recall_a_hall_default_80x60"]
        axis, = figure.axes
        self.near(line_of(axis, "box, stop"), [[61, 62, 64], [80, 70, 50]])
        self.near(line_of(axis, "plane, stop"), [[81], [80]])
        self.assertIn("plane, stop is the best: F1 80.0 %; a box reaches 60.0 %", figure.finding)
        best = plots.surfaces.ladder(results)
        self.assertEqual(list(zip(best.scene, best.surface, best.behind, best.thickness_m)), [
            (scene, *model, 0.2) for scene in ("a_hall", "b_hall") for model in (("plane", "stop"), ("box", "stop"), ("box", "hit"))])
        self.near(best.solid_backs_ms, [0.5, 0, 0] * 2)
        self.near(best.recall_1px, [0.81, 0.62, 0.52] * 2)
        self.near(best.precision_1px, [0.8, 0.7, 0.7] * 2)
        at = {text.get_text(): text.xy for text in axis.texts}
        self.assertEqual(list(at), ["0.1 m", "0.4 m", "plane, stop", "box, stop", "box, hit"])
        self.near(list(at.values()), [[61, 80], [64, 50], [81, 80], [62, 70], [52, 70]])  # names at the best F1

    def test_surface_models_from_elsewhere_stand_behind_the_ladder(self):
        results = self.surfaces(thicknesses=(0.1, 0.2), layers=(1, 2), models=(("felt", "stop", 0.7, 0), ("a_cloth", "hit", 0.7, 0), *self.MODELS))
        figures, _ = self.drawn(plots.surfaces.precision_against_recall, results)
        axis, = figures["surfaces_precision_recall_a_hall_default_80x60"].axes
        self.near(line_of(axis, "felt, stop"), [[71, 72], [80, 70]])
        figures, _ = self.drawn(plots.surfaces.ladder_of_layers, results)
        self.assertEqual([label.get_text() for label in figures["surfaces_ladder"].axes[1].get_xticklabels()][-2:], ["felt, stop", "felt, stop, 2 layers"])

    def test_what_surface_models_cost(self):
        results = self.surfaces()
        results.rows = pd.concat([results.rows, results.rows.assign(width=40, f1_1px=0.0)])  # smaller pictures do not count
        figures, _ = self.drawn(plots.surfaces.f1_against_time, results)
        axis, = figures["surfaces_f1_time"].axes
        self.near(line_of(axis, "plane, stop"), [[3.25, 3.35], [70, 80]])
        self.near(line_of(axis, "box, hit"), [[2.75, 2.85], [40, 50]])
        figures, _ = self.drawn(plots.surfaces.ladder_of_layers, self.surfaces(thicknesses=(0.2,), layers=(2, 1)))
        found, cost = figures["surfaces_ladder"].axes
        self.assertEqual([label.get_text() for label in cost.get_xticklabels()],
                         ["box, hit", "box, stop", "box, hit, 2 layers", "box, stop, 2 layers", "plane, stop", "plane, stop, 2 layers"])
        self.near(line_of(found, "a_hall")[1], [40, 50, 45, 55, 70, 75])
        self.near(line_of(found, "b_hall")[1], [50, 60, 55, 65, 80, 85])
        parts = {part.get_label(): ([bar.get_height() for bar in part], [bar.get_y() for bar in part]) for part in cost.containers}
        self.near(parts["trace"], [[2.05] * 6, [0] * 6])
        self.near(parts["structures"], [[0.75] * 6, [2.05] * 6])
        self.near(parts["backs of solids"], [[0, 0, 0, 0, 0.5, 0.5], [2.8] * 6])
        self.near(parts["layers"], [[0, 0, 1, 1, 0, 1], [2.8, 2.8, 2.8, 2.8, 3.3, 3.3]])

    def test_f1_against_size(self):
        rows = [dict(scene=scene, technique="hiz", surface=surface, behind="stop", thickness_m=0.1, width=2 * height, height=height,
                     recall_1px=0.5, precision_1px=0.5, f1_1px=height / 1000 + more)
                for scene in ("a", "b") for surface, more in (("box", 0), ("plane", 0.25)) for height in (400, 100, 200)]
        figures, _ = self.drawn(plots.surfaces.f1_against_size, made_results(self, rows, ["surface", "behind", "thickness_m"]))
        axis, = figures["surfaces_f1_size"].axes  # means of the scenes
        self.near(line_of(axis, "box, stop"), [[100, 200, 400], [10, 20, 40]])
        self.near(line_of(axis, "plane, stop"), [[100, 200, 400], [35, 45, 65]])
        self.assertIn("At 100p plane, stop is the best: F1 35.0 %; a box reaches 10.0 %, at 400p 40.0 %", figures["surfaces_f1_size"].finding)

    def sequence(self, summary, rows=({"technique": "dda"},), inputs=()):
        results = made_results(self, rows, inputs)
        write_table(self.path("out/sequence_summary.csv"), summary)
        return results

    def test_flips_under_jitter(self):
        results = self.sequence([dict(scene="s", technique="linear", steps=steps, flip_rate=rate) for steps, rate in ((64, 0.01), (8, 0.2), (16, 0.1))] +
                                [dict(scene="s", technique="dda", flip_rate=0.005)])
        figures, _ = self.drawn(plots.sequences.flips_under_jitter, results)
        axis, = figures["jitter_flips"].axes
        self.near(line_of(axis, "linear"), [[8, 16, 64], [20, 10, 1]])
        self.near(line_of(axis, "dda")[1], [0.5, 0.5])

    def test_errors_of_motion_and_reprojection(self):
        views = [("pan", 0.5, 2, 0.25), ("truck", 1, 4, 0.1)]
        results = self.sequence([dict(scene="s", view=view, surface_motion_error_median_px=median, surface_motion_error_p95_px=p95, disocclusion_share=share)
                                 for view, median, p95, share in views] + [dict(scene="s", view="still")])
        figures, _ = self.drawn(plots.sequences.motion_errors, results)
        error, unseen = figures["motion_errors"].axes
        bars = {one.get_label(): [bar.get_height() for bar in one] for one in error.containers}
        self.near([bars["median"], bars["95th percentile"]], [[0.5, 1], [2, 4]])
        self.near([bar.get_height() for bar in unseen.containers[0]], [25, 10])
        self.assertEqual([label.get_text() for label in unseen.get_xticklabels()], ["pan", "truck"])

        weights = [dict(scene="s", view=view, reprojection=name, history_weight=0.9, reprojection_error_median_px=error, reprojection_error_p95_px=3 * error,
                        ghosting_rmse=error / 10) for view in ("default", "pan") for name, error in (("mine", 4), ("plane", 1), ("surface", 2), ("plane", 3))]
        results = self.sequence(weights + [dict(scene="s", view="pan", reprojection="plane", history_weight=0, ghosting_rmse=0.75)])
        figures, _ = self.drawn(plots.sequences.reprojection_errors, results)
        figure = figures["reprojection_errors"]
        median, p95, ghosts = figure.axes[:3]
        for axis, factor in ((median, 1), (p95, 3), (ghosts, 0.1)):
            self.assertEqual([one.get_label() for one in axis.get_lines()[:3]], ["surface", "plane", "mine"])
            self.near([one.get_xdata() for one in axis.get_lines()[:3]], factor * np.array([[2, 2], [2, 2], [4, 4]]))
        self.near(line_of(ghosts, "no history")[0], [np.nan, 0.75])
        self.assertEqual([label.get_text() for label in ghosts.get_yticklabels()], ["objects only", "pan"])
        self.assertRegex(figure.finding, r"(plane|surface) knows best where a reflection was: 95 % within 6 px; mine within 12 px")

    def test_a_panel_shows_its_part_of_the_picture(self):
        picture = np.arange(6 * 8).reshape(6, 8, 1)
        self.near(plots.panels.cropped(picture, {"crop": [5, 1, 3, 2]})[:, :, 0], [[13, 14, 15], [21, 22, 23]])
        self.near(plots.panels.cropped(picture, {}), picture)

    def test_a_panel_whose_run_failed(self):
        rows = pd.DataFrame([dict(run_id="a", steps=8), dict(run_id="b", steps=16)])
        self.assertEqual(plots.panels.row_of(rows, {"run_id": "b", "steps": 16, "show": "causes"}, "one").steps, 16)
        with self.assertRaisesRegex(SystemExit, r"\[figures.one\]: run c has no picture"):
            plots.panels.row_of(rows, {"run_id": "c"}, "one")

    def test_names_say_what_differs(self):
        self.assertEqual(plots.paper.short_names(["hiz, stop, box", "hiz, stop, plane"]), {"hiz, stop, box": "box", "hiz, stop, plane": "plane"})
        self.assertEqual(plots.paper.short_names(["hiz", "hiz, box"]), {"hiz": "hiz", "hiz, box": "hiz, box"})

    def test_clamping_and_convergence(self):
        summary = [dict(scene="s", view=f"waves_{waves}_roughness_{roughness}", history_clamping=clamping, clamped_share=share)
                   for clamping, most in (("minmax", 0.8), ("variance", 0.4), ("off", 0.9))
                   for waves, roughness, share in ((4, 0.1, most), (0, 0.1, most / 2), (4, 0.3, most / 4))]
        rows = [dict(technique="dda", view="waves_2_roughness_0.1", frame=frame, history_weight=weight, history_clamping=clamping, converged_rmse=error + other,
                     run_number=0)
                for other in (0, 0.2)
                for weight, clamping, frame, error in ((0, "minmax", 0, 0.5), (0, "minmax", 7, 0.4), (0.9, "minmax", 0, 0.5), (0.9, "minmax", 7, 0.1))]
        results = self.sequence(summary, rows, ["history_weight", "history_clamping"])
        figures, _ = self.drawn(plots.sequences.clamped_history, results)
        left, right = figures["clamped_history"].axes
        self.assertEqual((left.get_title("left"), right.get_title("left")), ("minmax", "variance"))
        self.near(line_of(left, "roughness 0.1"), [[0, 4], [40, 80]])
        self.near(line_of(right, "roughness 0.3"), [[4], [10]])
        figures, _ = self.drawn(plots.sequences.convergence, results)
        axis, = figures["convergence"].axes
        self.assertEqual(axis.get_title("left"), "2 waves per metre")
        self.near(line_of(axis, "no history"), [[1, 8], [0.6, 0.5]])
        self.near(line_of(axis, "minmax"), [[1, 8], [0.6, 0.2]])


if __name__ == "__main__":
    main()
