"""roio-cli kind and roio-cli robot as one uses them: files, standard output, --check, and what is wrong.

ROIO_CLI names the program, ROIO_SOURCES the tree.
"""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

GUARD = 60  # seconds
SOURCES = pathlib.Path(os.environ["ROIO_SOURCES"])
KIND = SOURCES / "kinds/servo-arm.kind.json"
ROBOT = SOURCES / "examples/arm-robot/robot.json"

ARM_ROBOT = """\
arm robot, version 1.0
bus local:robot, 500000 bit/s
3 places, 2 kinds
  0.2   arm      servo-arm
  0.3   sensors  sensor-board
  0.10  pc                     Where people and programs are
servo-arm hears
  angles    3 bytes    shoulder, elbow, hand
  refusals  0 bytes
servo-arm says
  refusals  2 bytes    count
sensor-board says
  values  6 bytes    light, button1, button2, pot1, pot2, pot3
"""

VALVE = """{
  "roio": 1, "kind": "valve", "description": "A valve, and *nothing* else",
  "hears": {"set": {"tag": 7, "description": "Turns it", "fields": [
    {"name": "fast", "type": "bits"},
    {"name": "way", "type": "enum", "width": 2, "values": {"open": 0, "shut": 2}},
    {"name": "angle", "type": "i16", "unit": "deg", "scale": "1/10", "minimum": -90, "maximum": 90},
    {"name": "rest", "type": "bytes", "description": "For|later"}]}},
  "settings": [{"name": "spring", "type": "u8", "unit": "N", "maximum": 20}]
}"""

VALVE_PAGE = """\
<!-- Made by `roio-cli kind md` from valve.kind.json: change that, and make this again. -->
# valve

A valve, and \\*nothing\\* else

Bytes are counted from 1, bits from 7, the highest, to 0.

## It hears

### set

Turns it

4 to 8 bytes; the first is 7 (0x07).

| byte | field | type | range | step | |
| --- | --- | --- | --- | --- | --- |
| 2, bit 7 | fast | bits | 0 to 1 | 1 |  |
| 2, bits 6..5 | way | enum | open (0), shut (2) |  |  |
| 3..4 | angle | i16 | -90 to 90 deg | 1/10 |  |
| 5.. | rest | bytes | 0 to 4 bytes |  | For\\|later |

## Settings

Set for a place by the robot's file; on no wire.

| field | type | range | step | |
| --- | --- | --- | --- | --- |
| spring | u8 | 0 to 20 N | 1 |  |
"""


def run(*words, cwd=None):
    """Exit status, output, errors."""
    done = subprocess.run([os.environ["ROIO_CLI"], *map(str, words)], capture_output=True, text=True, timeout=GUARD,
                          cwd=cwd)
    return done.returncode, done.stdout, done.stderr


class CommandTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name


class Making(CommandTest):
    COMMANDS = [("kind", "header", KIND), ("kind", "js", KIND), ("kind", "md", KIND), ("robot", "dbc", ROBOT)]

    def test_the_same_to_a_file_and_to_standard_output(self):
        for *command, source in self.COMMANDS:
            with self.subTest(command):
                out = self.folder / "out"
                status, made, errors = run(*command, source)
                self.assertEqual((status, errors), (0, ""))
                self.assertEqual(run(*command, "-o", out, source), (0, "", ""))
                self.assertEqual(out.read_text(), made)
                self.assertIn(f"Made by `roio-cli {' '.join(command)}` from {source.name}: change that, and make this "
                              "again.", made.split("\n")[0])

    def test_a_page(self):
        self.assertEqual(run("kind", "md", self.write("valve.kind.json", VALVE)), (0, VALVE_PAGE, ""))

    def test_over_an_older_and_longer_file(self):
        out = self.write("out", "x" * 100000)
        self.assertEqual(run("kind", "md", "-o", out, KIND), (0, "", ""))
        self.assertEqual(out.read_text(), run("kind", "md", KIND)[1])

    def test_never_over_its_source(self):
        source = self.write("valve.kind.json", VALVE)
        self.assertEqual(run("kind", "md", "-o", "./valve.kind.json", source, cwd=self.folder),
                         (1, "", "roio-cli: ./valve.kind.json: is what would be read; expected another file to write\n"))
        self.assertEqual(source.read_text(), VALVE)

    def test_where_nothing_can_be_written(self):
        for out, why in ((self.folder / "none/out", "No such file or directory"), (self.folder, "Is a directory")):
            self.assertEqual(run("kind", "md", "-o", out, KIND), (1, "", f"roio-cli: {out}: {why}\n"))

    def test_a_full_disk(self):
        self.assertEqual(run("kind", "md", "-o", "/dev/full", KIND),
                         (1, "", "roio-cli: /dev/full: No space left on device\n"))


class Checking(CommandTest):
    def test_fresh_stale_and_missing(self):
        for *command, source in Making.COMMANDS:
            with self.subTest(command):
                out = self.folder / "out"
                out.unlink(missing_ok=True)
                self.assertEqual(run(*command, "--check", "-o", out, source),
                                 (1, "", f"roio-cli: {out}: No such file or directory\n"))
                self.assertFalse(out.exists(), "it writes nothing")
                run(*command, "-o", out, source)
                self.assertEqual(run(*command, "--check", "-o", out, source), (0, "", ""))
                stale = out.read_text() + "\n"
                out.write_text(stale)
                self.assertEqual(run(*command, "--check", "-o", out, source),
                                 (1, "", f"roio-cli: {out}: is not what {source} makes; `roio-cli {' '.join(command)} "
                                         f"-o {out} {source}` makes it anew\n"))
                self.assertEqual(out.read_text(), stale)

    def test_a_kind_that_has_changed(self):
        source = self.write("valve.kind.json", VALVE)
        out = self.folder / "valve.h"
        run("kind", "header", "-o", out, source)
        source.write_text(VALVE.replace('"tag": 7', '"tag": 8'))
        self.assertEqual(run("kind", "header", "--check", "-o", out, source)[0], 1)

    def test_a_folder_is_no_file(self):
        self.assertEqual(run("kind", "md", "--check", "-o", self.folder, KIND),
                         (1, "", f"roio-cli: {self.folder}: Is a directory\n"))


class Wrong(CommandTest):
    """Wrong files: one line, exit 1, and what there was stays."""

    def test_a_kind(self):
        source = self.write("valve.kind.json", VALVE.replace("i16", "i17"))
        out = self.write("out", "as it was")
        for language in ("header", "js", "md"):
            status, made, errors = run("kind", language, "-o", out, source)
            self.assertEqual((status, made), (1, ""))
            self.assertRegex(errors, rf'^roio-cli: {source}:6: hears\.set\.fields\[2\]\.type: "i17".*\n$')
            self.assertEqual(out.read_text(), "as it was")

    def test_a_header_of_all_256_choices_compiles_without_a_warning(self):
        values = {f"v{i}": i for i in range(256)}
        kind = self.write("Servo.kind.json", json.dumps({"roio": 1, "kind": "Servo", "hears": {
            "go": {"fields": [{"name": "way", "type": "enum", "values": values}]}}}))
        header = self.folder / "servo.hpp"
        self.assertEqual(run("kind", "header", "-o", header, kind), (0, "", ""))
        self.assertIn("namespace Servo_ {", header.read_text(), "beside Arduino's class")
        source = self.write("use.cpp", '#include "servo.hpp"\n')
        done = subprocess.run([os.environ["CXX"], "-std=c++11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", source],
                              capture_output=True, text=True, timeout=GUARD)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_none_there(self):
        for command in (["kind", "header"], ["robot", "check"], ["robot", "dbc"]):
            status, made, errors = run(*command, self.folder / "none.kind.json")
            self.assertEqual((status, made, errors.count("\n")), (1, "", 1))
            self.assertIn("No such file or directory", errors)

    def test_a_robot_whose_kind_is_not_there(self):
        robot = self.write("robot.json", ROBOT.read_text().replace('"sensor-board"', '"sensor-bored"'))
        shutil.copy(KIND, self.folder)
        for command in ("check", "dbc"):
            status, made, errors = run("robot", command, robot)
            self.assertEqual((status, made, errors.count("\n")), (1, "", 1))
            self.assertIn("sensor-bored", errors)

    def test_kinds_beside_the_program(self):
        # A program of its own, with share/roio/kinds beside its folder.
        program = self.folder / "tree/bin/roio-cli"
        kinds = self.folder / "tree/share/roio/kinds"
        program.parent.mkdir(parents=True)
        kinds.mkdir(parents=True)
        shutil.copy(os.environ["ROIO_CLI"], program)
        (kinds / "beside.kind.json").write_text('{"roio": 1, "kind": "beside", "hears": {"go": {}}}')
        robot = self.write("robot.json", '{"roio": 1, "name": "r", "places": {"a": {"address": "0.1", "kind": "beside"}}}')
        for command in ("check", "dbc"):
            result = subprocess.run([program, "robot", command, robot], capture_output=True, timeout=GUARD, text=True)
            self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_a_dbc_that_would_be_too_large(self):
        text = "x" * 1000
        hears = {name: {"description": text, "fields": [{"name": "x", "type": kind}]}
                 for name, kind in (("a", "u8"), ("b", "u16"))}
        self.write("crowd.kind.json", json.dumps({"roio": 1, "kind": "crowd", "hears": hears}))
        places = {f"p{i}": {"address": f"{i // 100}.{i % 100}", "kind": "crowd"} for i in range(200)}
        robot = self.write("robot.json", json.dumps({"roio": 1, "name": "crowd", "places": places}))
        self.assertEqual(run("robot", "dbc", robot),
                         (1, "", f"roio-cli: {robot}: its DBC has more than 64 MiB; expected at most so many\n"))

    def test_a_robot_of_too_many_places_for_a_dbc(self):
        def robot(count):
            places = {f"p{i}": {"address": f"{i // 100}.{i % 100}"} for i in range(count)}
            return self.write("robot.json", json.dumps({"roio": 1, "name": "crowd", "places": places}))
        self.assertEqual(run("robot", "dbc", robot(201)),
                         (1, "", f"roio-cli: {self.folder / 'robot.json'}: 201 places; expected at most 200, as a DBC has "
                                 "a message for each two of them\n"))
        self.assertEqual(run("robot", "dbc", "-o", self.folder / "out", robot(200)), (0, "", ""))


class Checked(CommandTest):
    def test_what_a_robot_has(self):
        self.assertEqual(run("robot", "check", ROBOT), (0, ARM_ROBOT, ""))

    def test_tags_and_the_little_that_must_be_there(self):
        self.write("valve.kind.json", VALVE)
        robot = self.write("robot.json", '{"roio": 1, "name": "tap", "places": {"v": {"address": "3.4", "kind": "valve"}}}')
        self.assertEqual(run("robot", "check", robot), (0, """\
tap
1 place, 1 kind
  3.4  v  valve
valve hears
  set  4 to 8 bytes  tag 7  fast, way, angle, rest
""", ""))


if __name__ == "__main__":
    unittest.main(verbosity=2)
