#!/usr/bin/env python3
"""Sketches in place of images: built with Arduino's tools, kept in a cache, run."""

import os
import pathlib
import shutil
import signal
import subprocess
import time
import zipfile

from sim_driver import GUARD, SIM, UNO, SimTest, main

SHARE = pathlib.Path(SIM).parent.parent / "share/roio"
FAN = """#include <Roio.h>
#include "names.h"
constexpr uint32_t crystal_hz = 16000000;  // as it is printed on the module
RoioOn<10> roio;
void setup() {
  Serial.begin(115200);
  Serial.println(F(GREETING));
  pinMode(A1, OUTPUT);
  digitalWrite(A1, HIGH);
  pinMode(6, OUTPUT);
  blink();  // is below, which a sketch may do
}
void loop() {}
void blink() { digitalWrite(6, HIGH); }
"""
# Takes a ready image for the one that it was asked to build.
FAKE_CLI = f"""#!/bin/sh
for word; do echo "$word"; done >"$0.arguments"
while [ "$1" != --build-path ]; do shift; done
/bin/cp {UNO} "$2/Fan.ino.elf"
"""


class SketchTest(SimTest):
    def setUp(self):
        super().setUp()
        self.fan = pathlib.Path(self.path("Fan"))
        self.write("Fan.ino", FAN)
        self.write("names.h", '#define GREETING "hello"\n')
        self.cache = pathlib.Path(self.path("cache"))
        self.env = dict(os.environ, XDG_CACHE_HOME=str(self.cache))

    def write(self, name, text):
        self.fan.mkdir(exist_ok=True)
        (self.fan / name).write_text(text)

    def run_fan(self, *boards, sim=SIM):
        """Exit status, output, errors."""
        done = subprocess.run([sim, "--speed", "max", "--for", "0.1", *boards], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=GUARD, env=self.env, cwd=self.folder)
        return done.returncode, done.stdout, done.stderr

    def images(self):
        return sorted(path.name for path in self.cache.glob("roio/*/*.elf"))

    def path_of(self, *programs, **own):
        """A PATH that has these programs and no others; own ones by their text."""
        folder = pathlib.Path(self.path("path"))
        folder.mkdir()
        for name in programs:
            (folder / name).symlink_to(shutil.which(name))
        for name, text in own.items():
            file = folder / name.replace("_", "-")
            file.write_text(text)
            file.chmod(0o755)
        self.env["PATH"] = str(folder)
        return folder


class BuildTest(SketchTest):
    BUILDING = "roio-sim: building Fan for {} ...\n"

    def test_every_board(self):
        for board in ("uno", "nano", "leonardo", "micro", "mega"):
            with self.subTest(board):
                status, out, err = self.run_fan(f"arm:{board}=Fan")
                self.assertEqual((status, err), (0, self.BUILDING.format(board)))
                for line in ("arm: output: pin A1 high\n", "arm: output: pin 6 high\n"):
                    self.assertIn(line, out)
                if board in ("uno", "nano", "mega"):  # the others' USB is not set up so soon
                    self.assertIn("arm: serial: hello\n", out)

    def test_built_once_until_something_changes(self):
        building = self.BUILDING.format("uno")
        for path in ("Fan", "Fan/", "Fan/Fan.ino", str(self.fan)):
            with self.subTest(path):
                self.assertEqual(self.run_fan("uno=" + path)[::2], (0, building))
                building = ""
        self.write("names.h", '#define GREETING "good evening"\n')
        status, out, err = self.run_fan("uno=Fan")
        self.assertEqual((status, err), (0, self.BUILDING.format("uno")))
        self.assertIn("uno: serial: good evening\n", out)
        self.write("names.h", '#define GREETING "hello"\n')
        self.assertEqual(self.run_fan("uno=Fan")[::2], (0, ""), "as it was before")
        self.assertEqual(len(self.images()), 2)

    def test_two_at_once(self):
        both = [subprocess.Popen([SIM, "--speed", "max", "--for", "0.1", "uno=Fan"], stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=self.env,
                                 cwd=self.folder) for _ in range(2)]
        results = [one.communicate(timeout=GUARD) for one in both]
        for one, (out, err) in zip(both, results):
            self.assertEqual(one.returncode, 0, err)
            self.assertIn("uno: serial: hello\n", out)
        self.assertEqual(sum(err.count("building") for _, err in results), 1)
        self.assertEqual(len(self.images()), 1)

    def test_a_sketch_that_does_not_compile(self):
        self.write("Fan.ino", "void setup() { nonsense(); }\nvoid loop() {}\n")
        status, out, err = self.run_fan("uno=Fan/Fan.ino")
        self.assertEqual((status, out), (1, ""))
        lines = err.splitlines()
        self.assertEqual(lines[0], "roio-sim: building Fan for uno ...")
        self.assertRegex(err, rf"(?m)^{self.fan}/Fan.ino:1:\d+: error: .nonsense. was not declared in this scope$")
        self.assertEqual(lines[-1], "roio-sim: Fan/Fan.ino does not build for uno")
        self.assertEqual(self.images(), [])

    def test_another_library(self):
        prefix = pathlib.Path(self.path("prefix"))
        shutil.copytree(SHARE, prefix / "share/roio")
        (prefix / "bin").mkdir()
        shutil.copy(SIM, prefix / "bin")
        installed = prefix / "bin/roio-sim"
        # An installed tree, wherever it is, and through a link.
        linked = pathlib.Path(self.path("linked"))
        linked.symlink_to(installed)
        self.assertEqual(self.run_fan("uno=Fan", sim=installed)[::2], (0, self.BUILDING.format("uno")))
        self.assertEqual(self.run_fan("uno=Fan", sim=linked)[::2], (0, ""))
        library = next((prefix / "share/roio").glob("Roio-*.zip"))
        with zipfile.ZipFile(library, "a") as file:
            file.writestr("Roio/another", "file")
        self.assertEqual(self.run_fan("uno=Fan", sim=installed)[::2], (0, self.BUILDING.format("uno")))
        library.unlink()
        self.assertEqual(self.run_fan("uno=Fan", sim=installed),
                         (1, "", f"roio-sim: {library}: no such file; a sketch is built with it\n"))


class ViolationTest(SketchTest):
    # Two things that hardware does not put up with, 250 times each, in turn.
    WRONG = """void setup() {
  pinMode(10, OUTPUT);
  pinMode(11, OUTPUT);
  SPCR = _BV(SPE) | _BV(MSTR);
  for (int i = 0; i < 250; ++i) {
    digitalWrite(10, LOW);
    pinMode(13, INPUT);
    SPDR = 0;
    while (!(SPSR & _BV(SPIF))) {}
    digitalWrite(10, HIGH);
    pinMode(13, OUTPUT);
    SPDR = 0;
    SPDR = 0;
    while (!(SPSR & _BV(SPIF))) {}
  }
}
void loop() {}
"""

    def test_each_kind_is_told_once_and_counted(self):
        self.write("Fan.ino", self.WRONG)
        status, _, err = self.run_fan("uno=Fan")
        self.assertEqual((status, err), (0, "roio-sim: building Fan for uno ...\n" + "".join(
            f"roio-sim: uno: the hardware does not put up with this: {what} (250 times)\n"
            for what in ("SCK is not an output", "SPDR written while a byte is under way"))))


class ToolTest(SketchTest):
    def test_no_builder(self):
        self.path_of("python3", "avr-g++", "arduino-ctags")
        self.assertEqual(self.run_fan("uno=Fan"), (
            1, "", "roio-sim: arduino-builder is missing, which builds sketches; on Debian: sudo apt-get install "
                   "--no-install-recommends arduino-builder\n"))

    def test_no_tool_at_all(self):
        self.path_of("python3")
        status, _, err = self.run_fan("uno=Fan")
        self.assertEqual(status, 1)
        self.assertRegex(err, r"^roio-sim: arduino-builder is missing, [^\n]* arduino-builder arduino-ctags gcc-avr"
                              r"[^\n]*\n$")

    def test_no_python(self):
        self.path_of()
        self.assertEqual(self.run_fan("uno=Fan"), (
            1, "", "roio-sim: python3 is missing, which builds sketches; on Debian: sudo apt-get install "
                   "python3\n"))

    def test_arduino_cli(self):
        folder = self.path_of("python3", arduino_cli=FAKE_CLI)
        status, out, err = self.run_fan("nano=Fan")
        self.assertEqual((status, err), (0, "roio-sim: building Fan for nano ...\n"))
        self.assertIn("nano: serial: node 2\n", out)
        words = (folder / "arduino-cli.arguments").read_text().splitlines()
        self.assertEqual(words[:4], ["compile", "--fqbn", "arduino:avr:nano:cpu=atmega328", "--libraries"])
        self.assertEqual(words[-1], str(self.fan))

    def test_a_cache_that_cannot_be_written(self):
        self.cache.write_text("a file")
        status, out, err = self.run_fan("uno=Fan")
        self.assertEqual((status, out), (1, ""))
        self.assertEqual(err, f"roio-sim: {self.cache}/roio/uno: Not a directory\n")

    def test_a_signal_ends_the_build(self):
        # The builder's own processes go, too, and what they have made.
        marker = self.path("started")
        self.path_of("python3", "sleep", "touch",
                     arduino_cli=f"#!/bin/sh\nsleep 600 &\ntouch {marker}\nwait\n")
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                process = subprocess.Popen([SIM, "uno=Fan"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                           stderr=subprocess.PIPE, text=True, env=self.env, cwd=self.folder)
                self.addCleanup(process.kill)
                deadline = time.monotonic() + GUARD
                while not os.path.exists(marker) and time.monotonic() < deadline:
                    time.sleep(0.02)
                process.send_signal(number)
                out, err = process.communicate(timeout=GUARD)
                self.assertEqual((process.returncode, out, err),
                                 (128 + number, "", "roio-sim: building Fan for uno ...\n"))
                self.assertEqual(list(self.cache.glob("roio/build-*")), [])
                os.remove(marker)


class NoSketchTest(SketchTest):
    LINES = [
        ("Nosuch/Nosuch.ino", "Nosuch/Nosuch.ino: no such file"),
        ("Other", "Other: expected the sketch Other.ino in this folder"),
        ("Other/Fan.ino", "Other/Fan.ino: expected it in a folder of its name, Fan/Fan.ino"),
    ]

    def test_each_is_one_line_and_exit_2(self):
        other = pathlib.Path(self.path("Other"))
        other.mkdir()
        (other / "Fan.ino").touch()
        for path, expected in self.LINES:
            with self.subTest(path):
                self.assertEqual(self.run_fan("uno=" + path), (2, "", f"roio-sim: {expected}\n"))


if __name__ == "__main__":
    main()
