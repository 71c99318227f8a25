"""Random kinds: the C++ header and the ES module put the same values into the same bytes as roio::pack(),
and take them out as roio::unpack() does.

ROIO_SEED repeats a run. MAKE_PROPERTY is the program that writes kinds and checks; CXX compiles the header
as strictly as headers are compiled here, AVR_CXX with Arduino's core (ARDUINO) and all its macros, NODE runs
the module.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

GUARD = 200  # seconds
KINDS = 40
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wold-style-cast",
            "-Werror"]


def run(*words):
    """What it says; shows it and fails when it fails."""
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=GUARD)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))} ended with {done.returncode}:\n{done.stdout[:5000]}")
    return done.stdout


def count(text):
    return int(re.search(r"(\d+) checks", text)[1])


class Property(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        sys.stdout.write(run(os.environ["MAKE_PROPERTY"], cls.folder, KINDS))

    def test_header(self):
        program = self.folder / "check"
        run(os.environ["CXX"], "-std=c++11", "-O0", *WARNINGS, self.folder / "check.cpp", "-o", program)
        self.assertGreater(count(run(program)), 1000)

    @unittest.skipUnless(os.environ.get("AVR_CXX"), "no compiler for an Arduino")
    def test_header_beside_arduinos_own(self):
        sketch = self.folder / "sketch.cpp"
        headers = re.findall(r'^#include ".*"$', (self.folder / "check.cpp").read_text(), re.MULTILINE)
        self.assertEqual(len(headers), KINDS)
        sketch.write_text("\n".join(["#include <Arduino.h>", *headers, ""]))
        arduino = os.environ["ARDUINO"] + "/arduino/avr"
        run(os.environ["AVR_CXX"], "-mmcu=atmega328p", "-DF_CPU=16000000L", "-DARDUINO_ARCH_AVR", "-std=gnu++11", "-Os",
            "-Wall", "-Wextra", "-Werror", f"-I{arduino}/cores/arduino", f"-I{arduino}/variants/standard", "-c", sketch,
            "-o", self.folder / "sketch.o")

    def test_module(self):
        said = run(os.environ["NODE"], pathlib.Path(__file__).with_name("check_modules.mjs"), self.folder)
        self.assertGreater(count(said), 500)


if __name__ == "__main__":
    unittest.main(verbosity=2)
