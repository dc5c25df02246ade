"""tests/reruns: counts, quality and pictures are the same each time; what differs is found."""

from support import Case, load_script, main


class Test(Case):
    def test_the_same_each_time(self):
        self.assertRegex(self.script("reruns", "--times", "2"), r"2 reruns of [1-9]\d+ rows: 0 of [1-9]\d+ values and [1-9]\d+ pictures differ")

    def test_what_differs_is_found(self):
        module = load_script("tests", "reruns")
        first = ({"r1": {"steps_mean": "3", "trace_ms_median": "1", "hiz.ms_median": "1"}}, {"a.png": b"1"})
        same = ({"r1": {"steps_mean": "3", "trace_ms_median": "2", "hiz.ms_median": "2"}}, {"a.png": b"1"})
        self.assertEqual(module.differences(first, same), [])
        self.assertEqual(module.differences(first, ({"r1": {**same[0]["r1"], "steps_mean": "4"}}, same[1])), ["r1 steps_mean"])
        self.assertEqual(module.differences(first, (same[0], {"a.png": b"2", "b.png": b"1"})), ["a.png", "b.png"])
        self.assertEqual(module.differences(first, ({}, {})), ["the list of runs"])


if __name__ == "__main__":
    main()
