#!/usr/bin/env python3
"""Tests of the registry of faults: every entry fits the sources and is recorded; texts that do not fit are refused."""
import collections
import sys
import unittest

sys.dont_write_bytecode = True
from faults import ROOT, Edit, pick, read_record, registry  # noqa: E402
from select_mutants import Place, add, copies, place_of, selectable  # noqa: E402

FAULTS = registry()


class Registry(unittest.TestCase):
    def test_every_text_occurs_once(self):
        wrong = []
        for fault in FAULTS.values():
            for edit in fault.edits:
                try:
                    text = (ROOT / edit.file).read_text()
                    self.assertNotEqual(edit.put(text), text, fault.name)
                except (OSError, ValueError) as error:
                    wrong.append(f"{fault.name}: {error}")
        self.assertEqual(wrong, [])

    def test_all_are_selectable(self):
        for side in ("rtl", "model"):
            self.assertEqual(copies(side, [f for f in FAULTS.values() if f.selectable])[1], [])
        self.assertEqual(copies("rtl/wrap", [f for f in FAULTS.values() if f.of_wrapper])[1], [])

    def test_entries(self):
        for fault in FAULTS.values():
            rtl, model = fault.of("rtl"), fault.of("model")
            fits = {"rtl": rtl and not model, "model": model and not rtl, "common": model}[fault.side]
            self.assertTrue(fits, f"{fault.name}: files are not of its side")
            caught = fault.of_wrapper or any(fault.caught.get(key) for key in ("checks", "proofs", "replays"))
            self.assertTrue(fault.equivalent or caught, f"{fault.name}: has not been recorded (README.md)")
            seen = "checks" in fault.caught
            self.assertFalse(fault.equivalent and seen, f"{fault.name}: is called equivalent, yet a check sees it")
            self.assertTrue(not fault.equivalent or len(fault.equivalent) > 20, f"{fault.name}: no argument")
        self.assertEqual(set(read_record()) - set(FAULTS), set())
        self.assertEqual(len({fault.number for fault in FAULTS.values()}), len(FAULTS))

    def test_enough_of_each_side(self):
        """A unit without a fault is one whose checks nothing is said of."""
        by_hand = collections.Counter(f.side for f in FAULTS.values() if not f.generated and "checks" in f.caught)
        self.assertTrue(by_hand["rtl"] >= 190 and by_hand["model"] >= 17 and by_hand["common"] >= 108, by_hand)
        classes = {(f.side, f.fault_class) for f in FAULTS.values() if f.generated}
        self.assertEqual(collections.Counter(side for side, _ in classes), {"rtl": 9, "model": 7, "common": 7})
        self.assertEqual(sum(f.generated for f in FAULTS.values()), 330)
        # Without: constants of elaboration, and instances without an operator.
        units = {f"rtl/{path.name}" for path in (ROOT / "rtl").glob("*.sv")} - {"rtl/quadrille_config_check.sv", "rtl/quadrille_hidden_tiles.sv", "rtl/quadrille_pixel.sv"}
        units |= {f"rtl/wrap/{path.name}" for path in (ROOT / "rtl/wrap").glob("quadrille_*.sv")} - {"rtl/wrap/quadrille_register_map_pkg.sv", "rtl/wrap/quadrille_handshake_rules.sv"}
        self.assertEqual(units - {edit.file for f in FAULTS.values() for edit in f.edits}, set())


class Reader(unittest.TestCase):
    TEXT = "a = b;\nc = b;\n"

    def test_marks(self):
        edit = Edit.read(["f", "c = «b»;", "d"])
        self.assertEqual(edit.put(self.TEXT), "a = b;\nc = d;\n")
        self.assertEqual(edit.marked, "c = «b»;")
        self.assertEqual(edit.lines(self.TEXT), (2, "c = b;", "c = d;"))

    def test_not_once(self):
        for search in ("b", "e", "c = «e»"):
            with self.assertRaisesRegex(ValueError, "times, not once"):
                Edit.read(["f", search, "d"]).put(self.TEXT)

    def test_spans(self):
        """One in another is selectable in what is left. Those that overlap otherwise are refused."""
        top = Place(0, len(self.TEXT), True)
        add(top, Place(7, 13, True, [(1, "")]))
        add(top, Place(11, 12, False, [(2, "d")]))
        selected = "::quadrille::selected_mutant =="
        self.assertEqual(selectable(self.TEXT, top, "model"),
                         f"a = b;\nif ({selected} 1) {{  }} else {{ c = (({selected} 2) ? (d) : (b)); }}\n")
        with self.assertRaisesRegex(ValueError, "overlaps"):
            add(top, Place(5, 9, False, [(3, "")]))
        with self.assertRaisesRegex(ValueError, "expression replaces a statement"):
            place_of(FAULTS["rtl_tie_rule"], Edit.read(["f", "c = b;", "d"]), self.TEXT)

    def test_pick(self):
        self.assertEqual(pick("abc", 0), list("abc"))
        self.assertEqual({x for seed in range(50) for x in pick("abc", 1, seed)}, set("abc"))
        self.assertEqual(pick("abcdef", 3, 1), pick("abcdef", 3, "1"))


if __name__ == "__main__":
    unittest.main()
