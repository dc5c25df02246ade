"""Answers beyond the frame from the command line: the table, the file in long form, the picture, and what is refused."""
import csv
import os

from support import Case, main

SOURCES = ("sources", "builtin:corridor", "--size", "96x54", "-p", "surface=plane_infinite", "-p", "behind=stop")


class Test(Case):
    def read(self, name):
        with open(self.path(name), newline="") as file:
            return list(csv.DictReader(file))

    def test_writes_a_row_for_each_source_of_each_list(self):
        self.ssrlab(*SOURCES, "--sources", "frame,wider:margin=0.5,world", "--sources", "world", "-o", "sources.csv", says=["frame", "wider", "world"])
        rows = self.read("sources.csv")
        self.assertEqual([row["source"] for row in rows], ["frame", "wider:margin=0.5", "world", "world"])
        self.assertEqual([row["place"] for row in rows], ["0", "1", "2", "0"])
        frame, wider, world, alone = rows
        self.assertEqual(int(frame["handed"]), int(frame["all_rays"]))
        self.assertEqual(int(wider["handed"]), int(frame["handed"]) - int(frame["certain_points"]) - int(frame["certain_nothing"]))
        self.assertLessEqual(int(world["handed"]), int(wider["handed"]))
        self.assertEqual(alone["handed"], frame["handed"])
        self.assertLess(int(world["node_visits"]), int(alone["node_visits"]))
        self.assertGreater(float(alone["all_f1"]), 0.999)
        self.assertGreater(float(world["all_f1"]), float(frame["all_f1"]))
        for row in rows:
            classes = sum(int(row[name]) for name in row if name.startswith("handed_"))
            self.assertEqual(classes, int(row["meeting"]))
        # A second command appends.
        self.ssrlab(*SOURCES, "--sources", "frame", "-o", "sources.csv")
        self.assertEqual(len(self.read("sources.csv")), 5)

    def test_shows_which_source_answered(self):
        self.ssrlab("render", *SOURCES[1:], "-t", "hiz", "--show", "sources", "--sources", "frame,world", "-o", "shown.png")
        self.assertGreater(os.path.getsize(self.path("shown.png")), 500)

    def test_refuses_what_is_no_list(self):
        self.refused(*SOURCES, "--sources", "frame,wurld", code=2, says=["--sources frame,wurld", "unknown source 'wurld'", "world"])
        self.refused(*SOURCES, "--sources", "layers:count=9", code=2, says=["count", "9"])
        self.refused(*SOURCES, "--hand-on", "some", code=2, says=["--hand-on", "lost or uncertain", "some"])
        self.refused(*SOURCES, "-o", "sources.txt", code=2, says=[".csv"])


if __name__ == "__main__":
    main()
