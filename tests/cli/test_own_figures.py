"""Results in pandas, from the rows that are committed."""
import os
import sys

from support import SOURCE, Case, main

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
import plots.results  # noqa: E402

REFERENCE = os.path.join(SOURCE, "results", "reference", "lavapipe", "cost_of_accuracy")


class Test(Case):
    def test_results_are_typed_and_without_constants(self):
        rows = plots.results.load(REFERENCE)
        self.assertGreater(len(rows), 50)
        self.assertEqual(rows.recall_1px.dtype.kind, "f")
        self.assertNotIn("thickness_m", rows)
        self.assertEqual(rows.attrs["constants"]["thickness_m"], 0.1)
        self.assertEqual((rows.attrs["units"]["cost_ms_median"], rows.attrs["units"]["recall_1px"]), ("ms", "share"))
        self.assertTrue((rows.cost_ms_median >= rows.trace_ms_median).all())
        self.assertIn("thickness_m", plots.results.load(REFERENCE, keep_constants=True))


if __name__ == "__main__":
    main()
