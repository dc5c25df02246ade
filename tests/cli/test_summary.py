"""Speed-ups by pairs and the rows of summary.csv, on results made up here: no run, no device."""
import json
import os
import sys

from support import SOURCE, Case, main

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import plots.pairs  # noqa: E402
import plots.accuracy  # noqa: E402
import plots.styles  # noqa: E402
import plots.verdict  # noqa: E402
from plots.data import Results  # noqa: E402


def series(values, first_round=0):
    return pd.Series(values, index=range(first_round, first_round + len(values)), dtype=float)


# What people without red and without green cones see, in linear sRGB: Machado, Oliveira and Fernandes 2009, severity 1.
SIGHTS = [np.eye(3), np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
          np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]])]
TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])


def to_lab(colour, sight):
    encoded = np.array([int(colour[i:i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    xyz = TO_XYZ @ np.clip(sight @ linear, 0, 1) / np.array([0.95047, 1, 1.08883])
    root = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * root[1] - 16, 500 * (root[0] - root[1]), 200 * (root[1] - root[2])])


def difference(a, b):
    """Of two colours in CIELAB, for the eyes that tell them apart least."""
    return min(np.linalg.norm(to_lab(a, sight) - to_lab(b, sight)) for sight in SIGHTS)


class Test(Case):
    def test_drift_cancels_in_pairs(self):
        drift = np.linspace(1, 5, 12)
        ratio = plots.pairs.paired_ratio(series(3 * drift), series(drift))
        self.assertEqual((ratio.median, ratio.low, ratio.high, ratio.pairs), (3, 3, 3, 12))

    def test_only_common_rounds_are_pairs(self):
        ratio = plots.pairs.paired_ratio(series([8.0] * 9), series([2.0] * 9, first_round=3))
        self.assertEqual((ratio.median, ratio.pairs), (4, 6))
        self.assertTrue(np.isnan(plots.pairs.paired_ratio(series([1.0] * 3), series([1.0] * 3, first_round=9)).median))

    def test_interval_is_unknown_below_six_pairs(self):
        ratio = plots.pairs.paired_ratio(series([2.0] * 5), series([1.0] * 5))
        self.assertEqual(ratio.median, 2)
        self.assertTrue(np.isnan(ratio.low) and np.isnan(ratio.high))
        six = plots.pairs.paired_ratio(series([1, 2, 3, 4, 5, 6]), series([1.0] * 6))
        self.assertEqual((six.low, six.high), (1, 6))

    def test_interval_covers_as_often_as_promised(self):
        random = np.random.default_rng(5)
        for count in (6, 12, 20, 30):
            covered = 0
            for _ in range(1500):
                noise = np.exp(0.05 * random.standard_t(2, count))
                ratio = plots.pairs.paired_ratio(series(noise), series([1.0] * count))
                covered += ratio.low <= 1 <= ratio.high
            self.assertGreaterEqual(covered / 1500, 0.95 - 0.012, count)

    def test_interval_covers_where_neighbours_correlate(self):
        random = np.random.default_rng(6)
        covered = 0
        for _ in range(1000):
            noise = 0.01 * random.standard_t(3, 120)
            for i in range(1, 120):
                noise[i] += 0.3 * noise[i - 1]
            ratio = plots.pairs.paired_ratio(series(np.exp(noise[20:])), series([1.0] * 100))
            self.assertEqual(ratio.pairs, 100)
            covered += ratio.low <= 1 <= ratio.high
        self.assertGreaterEqual(covered / 1000, 0.95)

    def results(self, extra_time=0.0):
        """hiz 1 ms; dda 4 ms; linear 8, 20, 22, 90 ms at recalls 0.5, 0.98, 0.991, 0.999. linear_binary misses."""
        rows = [("h", "hiz", "", 1, 1.0, 0.9), ("d", "dda", "", 4, 1.0, 0.9), ("l1", "linear", 100, 8, 0.5, 0.8),
                ("l2", "linear", 900, 20, 0.98, 0.8), ("l3", "linear", 990, 22, 0.991, 0.8),
                ("l4", "linear", 4000, 90, 0.999, 0.8), ("b", "linear_binary", 50, 3, 0.7, 0.8)]
        table = ["run_id,scene,view,width,height,technique,steps,trace_ms_median,trace_ms_ci_low,trace_ms_ci_high,repeats,"
                 "structures_ms_median,depth_pyramid.ms_median,fetches_mean,screen_recall_1px,screen_precision_1px,screen_f1_1px,outcome,rays"]
        samples = ["run_id,round,pass,ms,cpu_ms"]
        for run, technique, steps, ms, recall, precision in rows:
            f1 = 2 * recall * precision / (recall + precision)
            table.append(f"{run},s,default,8,8,{technique},{steps},{ms},{ms},{ms},9,0,0,5,{recall},{precision},{f1},ok,64")
            for number in range(9):
                # Drift that all meet alike, and a pyramid's share for hiz.
                factor = 1 + 0.1 * number
                parts = {"trace": ms * factor, "shade": 77}
                if run == "h":
                    parts = {"trace": 0.75 * ms * factor, "depth_pyramid": 0.25 * ms * factor, "shade": 77}
                samples += [f"{run},{number},{name},{value!r}," for name, value in parts.items()]
                samples.append(f"{run},{number},frame,99,99")
        self.write("out/results.csv", "\n".join(table) + "\n")
        self.write("out/samples.csv", "\n".join(samples) + "\n")
        self.write("out/environment.json", json.dumps({
            "accuracy": "linear.steps=higher linear_binary.steps=higher",
            "specification": "[targets]\nscreen_recall_1px = [0.99]\n"}))
        return Results(self.path("out"))

    def test_speedups_come_first_and_include_the_bracket(self):
        summary = plots.accuracy.summary(self.results())
        first = summary.head(3)
        self.assertEqual(list(first.kind), ["speedup"] * 3)
        self.assertEqual(list(first.over), ["dda", "best other", "linear"])
        self.assertEqual(list(first.over_technique), ["dda", "linear", "linear"])
        dda, _, linear = (row for _, row in first.iterrows())
        self.assertAlmostEqual(dda.speedup, 4)
        self.assertAlmostEqual(dda.speedup_ci_low, 4)
        self.assertEqual((dda.bracket, dda.verdict), ("none", "faster"))
        # 990 steps reach 99 %, 900 do not: between 20 and 22 times.
        self.assertEqual((linear.run_id, linear.bracket), ("l3", "closed"))
        self.assertAlmostEqual(linear.speedup, 22)
        self.assertAlmostEqual(linear.speedup_ci_low, 20)
        self.assertAlmostEqual(linear.speedup_ci_high, 22)
        self.assertEqual((linear.recall, linear.precision), (0.991, 0.8))
        cheapest = summary[(summary.kind == "cheapest_for_target")].set_index("technique")
        self.assertEqual(cheapest.setting["linear_binary"], "not reached")
        self.assertEqual(cheapest.value["linear_binary"], 0.7)
        self.assertEqual(cheapest.missed_by["linear"], "l2")

    def test_the_verdict_names_the_cheapest_that_reaches_the_target(self):
        results = self.results()
        chosen = plots.verdict.picks(results)
        self.assertEqual(list(chosen.run_id), ["h", "d", "l3", "b"])
        self.assertEqual(list(chosen.reached), [True, True, True, False])
        (_, text), = plots.verdict.verdicts(results, chosen)
        for part in ("hiz is the cheapest tracer that finds 99 % of what the depth buffer holds: 1 ms", "4 [4, 4] times as fast as dda", "22 [22, 22] times as fast as linear (steps 990)"):
            self.assertIn(part, text)
        ranked = plots.verdict.ranking(results, chosen)
        self.assertEqual(list(ranked.label), ["hiz", "dda", "linear", "linear_binary"])

    def test_24_techniques_look_different(self):
        names = plots.styles.PLACES + [f"mine_{i}" for i in range(plots.styles.SLOTS - len(plots.styles.PLACES))]
        slots = plots.styles.slots(names)
        looks = {(plots.styles.look(slot)[0], plots.styles.look(slot)[2]) for slot in slots.values()}
        self.assertEqual(len(looks), 24)
        self.assertEqual(plots.styles.slots(["hiz", "mine_3"])["hiz"], slots["hiz"], "a place does not depend on the others")
        for dark in (0, 1):
            for one in range(24):
                for other in range(one):
                    a, b = plots.styles.look(one), plots.styles.look(other)
                    if a[2] == b[2]:
                        self.assertGreater(difference(a[dark], b[dark]), 15, (one, other))

    def test_without_samples_the_interval_is_unknown(self):
        self.results()
        os.remove(self.path("out/samples.csv"))
        row = plots.accuracy.summary(Results(self.path("out"))).iloc[0]
        self.assertEqual((row.speedup, row.pairs, row.verdict), (4, 0, "not known"))
        self.assertTrue(np.isnan(row.speedup_ci_low))

    def test_a_line_that_begins_at_the_target_is_no_closed_bracket(self):
        results = self.results()
        results.rows = results.rows[~results.rows.run_id.isin(["l1", "l2"])]
        row = plots.accuracy.summary(results).iloc[2]
        self.assertEqual((row.run_id, row.bracket, row.verdict), ("l3", "open", "not known"))

    def test_unknown_intervals_are_hollow(self):
        from plots.data import errors, known
        rows = pd.DataFrame({"t_median": [2.0, 3.0], "t_ci_low": [1.0, np.nan], "t_ci_high": [4.0, np.nan]})
        low, high = errors(rows, "t")
        self.assertEqual((low[0], high[0]), (1, 2))
        self.assertTrue(np.isnan(low[1]) and np.isnan(high[1]))
        self.assertEqual(list(known(rows, "t")), [True, False])
        from plots.paper import plt
        figure, axis = plt.subplots()
        plots.accuracy.draw_intervals(axis, rows.assign(error=[0.1, 0.2]), "t_median", "error", {"color": "#000000", "marker": "o"})
        bars, hollow = axis.containers[0][2][0].get_segments(), axis.get_lines()[-1]
        self.assertEqual([segment[:, 0].tolist() for segment in bars], [[1, 4]])
        self.assertEqual((list(hollow.get_xdata()), hollow.get_markerfacecolor()), ([3], "white"))
        plt.close(figure)


if __name__ == "__main__":
    main()
