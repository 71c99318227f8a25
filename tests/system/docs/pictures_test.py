"""The documents' pictures: fresh, well made, legible, and where the documents say; and what docs/hardware.md computes."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

SOURCE = pathlib.Path(os.environ["ROIO_SOURCE"])
PICTURES = SOURCE / "docs/pictures"
DOCUMENTS = [SOURCE / "README.md", *sorted(SOURCE.glob("docs/**/*.md"))]
SVG = "{http://www.w3.org/2000/svg}"
# A home, a temporary file, or the checkout that the pictures were made in.
MACHINE_PATH = rf"(?:/home/|/root/|/Users/|{re.escape(str(SOURCE))}/|/tmp/(?!demo\.))\S*"
GUARD = 60  # seconds; against hanging only

sys.dont_write_bytecode = True
sys.path.insert(0, str(PICTURES))
import draw  # noqa: E402  (docs/pictures/draw.py)
import identifier  # noqa: E402
import kit  # noqa: E402


def drawings():
    return sorted(PICTURES.glob("*.svg"))


def run_draw(folder, *arguments):
    return subprocess.run([sys.executable, folder / "draw.py", *arguments], timeout=GUARD, capture_output=True, text=True)


class Drawing(unittest.TestCase):
    def test_every_picture_is_fresh(self):
        done = run_draw(PICTURES, "--check")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_stale_one_is_named_and_drawn_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "pictures"
            shutil.copytree(PICTURES, copy)
            shutil.copy(SOURCE / "docs/protocol.md", folder)
            (copy / "bus.svg").write_text((copy / "bus.svg").read_text().replace("120 Ω", "220 Ω"))
            (copy / "bridge.svg").unlink()
            done = run_draw(copy, "--check")
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertEqual(done.stderr, "draw.py: bus.svg is stale: run docs/pictures/draw.py\n"
                                          "draw.py: bridge.svg is stale: run docs/pictures/draw.py\n")
            done = run_draw(copy)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "drew bus.svg\ndrew bridge.svg\n", ""))
            self.assertEqual((copy / "bus.svg").read_bytes(), (PICTURES / "bus.svg").read_bytes())

    def test_a_name_that_is_none_is_refused(self):
        done = run_draw(PICTURES, "--check", "buss")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r"^draw\.py: expected one of wiring-uno, bus, .*; got 'buss'\n$")

    def test_every_svg_has_a_source(self):
        self.assertEqual([path.stem for path in drawings()], sorted(draw.PICTURES))


class Svg(unittest.TestCase):
    def test_well_formed_with_title_and_description(self):
        for path in drawings():
            with self.subTest(picture=path.name):
                root = ElementTree.parse(path).getroot()
                self.assertEqual((root.tag, root.get("role"), root.get("aria-labelledby")), (f"{SVG}svg", "img", "title desc"))
                for tag, least in (("title", 5), ("desc", 60)):
                    element = root.find(f"{SVG}{tag}")
                    self.assertEqual(element.get("id"), tag)
                    self.assertGreaterEqual(len(element.text), least)
                self.assertEqual(root.get("viewBox"), f"0 0 {root.get('width')} {root.get('height')}")

    def test_needs_nothing_from_elsewhere(self):
        for path in drawings():
            text = path.read_text().replace('xmlns="http://www.w3.org/2000/svg"', "")
            self.assertNotRegex(text, r"https?:|<script|href=|url\(|@import|<image", path.name)

    def test_names_no_machine(self):
        for path in sorted(PICTURES.glob("*")):
            if path.suffix in (".svg", ".cast", ".py"):
                places = re.findall(MACHINE_PATH, path.read_text())
                self.assertEqual(places, [], path.name)

    def test_texts_stay_inside(self):
        """Widths as in the widest of the usual fonts."""
        for path in drawings():
            root = ElementTree.parse(path).getroot()
            for text in root.findall(f"{SVG}text"):  # those in a transformed or nested part are not looked at
                style = set(text.get("class", "").split())
                size = 12 if "small" in style else 16 if "big" in style else 14
                advance = 0.602 if "mono" in style else 0.68 if "bold" in style else 0.6
                width = advance * size * len(text.text)
                left = float(text.get("x", "nan")) - width * {"middle": 0.5, "end": 1}.get(text.get("text-anchor"), 0)
                if text.get("transform"):
                    continue
                with self.subTest(picture=path.name, text=text.text):
                    self.assertGreaterEqual(left, 8)
                    self.assertLessEqual(left + width, int(root.get("width")) - 8)

    def test_legible_in_light_and_dark(self):
        def luminance(colour):
            parts = [int(colour[at:at + 2], 16) / 255 for at in (1, 3, 5)]
            linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
            return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

        def contrast(one, other):
            low, high = sorted((luminance(one), luminance(other)))
            return (high + 0.05) / (low + 0.05)

        for palette in (kit.LIGHT, kit.DARK):
            for colour in kit.TEXT_COLOURS:
                for ground in kit.GROUNDS:
                    with self.subTest(colour=palette[colour], ground=palette[ground]):
                        self.assertGreaterEqual(contrast(palette[colour], palette[ground]), 4.5)
        for path in drawings():
            self.assertIn("@media(prefers-color-scheme:dark)", path.read_text(), path.name)

    def test_moves_only_where_motion_is_welcome(self):
        for path in drawings():
            text = path.read_text()
            if "animation:" in text:
                self.assertIn("@media(prefers-reduced-motion:no-preference){.scroll{animation:", text, path.name)


class Documents(unittest.TestCase):
    def test_every_picture_named_exists_and_is_described(self):
        for document in DOCUMENTS:
            text = document.read_text()
            found = re.findall(r"!\[([^\]]*)\]\(([^)\s]+)\)", text)
            found += [(re.search(r'alt="([^"]*)"', tag)[1] if "alt=" in tag else "", source)
                      for tag, source in re.findall(r'(<img[^>]*src="([^"]+)"[^>]*>)', text)]
            for alternative, source in found:
                with self.subTest(document=document.name, picture=source):
                    self.assertTrue((document.parent / source).is_file(), f"{source} does not exist")
                    self.assertTrue(alternative.strip(), f"{source} has no alternative text")

    def test_identifier_is_the_protocols_example(self):
        protocol = (SOURCE / "docs/protocol.md").read_text()
        row = re.search(r"(?m)^\| arm, three angles +\|.*\| ([0-9A-F]{8}) +\| \1#", protocol)
        self.assertEqual(f"{identifier.identifier():08X}", row[1])


class Recording(unittest.TestCase):
    def test_is_a_whole_asciicast(self):
        header, *events = [json.loads(line) for line in (PICTURES / "demo.cast").read_text().splitlines()]
        self.assertEqual(sorted(header), ["height", "title", "version", "width"])
        self.assertEqual(header["version"], 2)
        times = [when for when, _, _ in events]
        self.assertEqual(times, sorted(times))
        output = "".join(data for _, kind, data in events if kind == "o")
        self.assertTrue(output.startswith("$ scripts/demo\r\n"))
        self.assertIn("The boards showed:", output)
        self.assertIn("arm: servo: pin 6 at 180 degrees", output)


def table(document, first_cell):
    """The rows of the table whose head begins with that cell, as texts."""
    lines = document[document.index(f"\n| {first_cell} |") + 1:].split("\n\n")[0].splitlines()
    return [[cell.strip(" *") for cell in line.strip("|").split("|")] for line in lines if not line.startswith("| ---")]


class Hardware(unittest.TestCase):
    def setUp(self):
        self.document = (SOURCE / "docs/hardware.md").read_text()

    def test_parts_are_added_up_and_below_5_eur(self):
        _, *parts, last = table(self.document, "part")
        for column in (2, 3):
            total = sum(round(100 * float(part[column])) for part in parts)
            self.assertEqual(f"{total / 100:.2f}", last[column])
            self.assertLess(total, 500)

    def test_parts_are_those_of_schematic_and_plan(self):
        listed = {name for row in table(self.document, "part")[1:-2] for name in row[0].split(", ")}
        for picture in ("schematic", "board-plan"):
            drawn = set(re.findall(r"\b(?:U[12]|[CDYF]\d|R\d|J[12]|JP1)\b", (PICTURES / f"{picture}.svg").read_text()))
            self.assertEqual(drawn, listed, picture)

    def test_voltage_drop_is_what_the_formula_gives(self):
        head, *rows = table(self.document, "wire")
        current = float(re.search(r"With I = (\d+) mA", self.document)[1]) / 1000
        cases = [re.fullmatch(r"(\d+) nodes, (\d+) m", cell).groups() for cell in head[2:]]
        for row in rows:
            expected = [f"{float(row[1]) * int(length) * current * (int(nodes) + 1):.2f}" for nodes, length in cases]
            self.assertEqual(row[2:], expected, row[0])

    def test_length_is_what_the_formula_gives(self):
        for rate, _, worst, *_ in table(self.document, "bit rate")[1:]:
            number, unit = rate.split()
            bit_ns = 1e9 / (float(number) * {"Mbit/s": 1e6, "kbit/s": 1e3}[unit])
            length = ((0.75 if unit == "Mbit/s" else 0.875) * bit_ns - 2 * 250) / (2 * 5)
            self.assertEqual(worst, f"{length:.0f} m", rate)


if __name__ == "__main__":
    unittest.main()
