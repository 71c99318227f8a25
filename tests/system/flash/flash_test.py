#!/usr/bin/env python3
"""scripts/flash: what it asks avrdude to do, what it refuses, and that the real avrdude writes an image so.

ROIO_SOURCE and ROIO_BUILD name the source and build folders; the bridge's images are built."""

import os
import pathlib
import subprocess
import tempfile
import termios
import unittest

from bootloaders import Caterina, Optiboot, Stk500v2, TouchedPort

SOURCE = pathlib.Path(os.environ["ROIO_SOURCE"])
BUILD = os.environ["ROIO_BUILD"]
GUARD = 240  # seconds; against hanging only

FAKE = """#!/bin/sh
for word; do echo "$word"; done >"$0.arguments"
exit ${FAKE_STATUS:-0}
"""
SKETCHES = "bridge_usb, " + ", ".join(sorted(
    folder.name for folder in (SOURCE / "firmware/arduino/examples").iterdir()))


def image_of(board, sketch="bridge_usb"):
    """What the board's flash is to hold: the image's bytes from address 0."""
    elf, binary = f"{BUILD}/firmware/{board}/{sketch}.elf", f"{BUILD}/firmware/{board}/{sketch}.bin"
    subprocess.run(["avr-objcopy", "-O", "binary", "-R", ".eeprom", elf, binary], check=True)
    return pathlib.Path(binary).read_bytes()


class FlashTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def flash(self, *words, env=None):
        """Exit status, output, and what it said itself."""
        done = subprocess.run([SOURCE / "scripts/flash", *words], capture_output=True, text=True,
                              timeout=GUARD, cwd=self.folder, env=env)
        said = [line for line in done.stderr.splitlines() if line.startswith("flash: ")]
        self.all_said = done.stderr
        return done.returncode, done.stdout, said

    def port(self, terminal):
        self.addCleanup(terminal.close)
        return terminal


class DryRunTest(FlashTest):
    HEX = "-D -U flash:w:build/release/firmware/{}.hex:i\n"
    LINES = [
        ("uno /dev/ttyACM0 bridge_usb",
         "avrdude -p atmega328p -c arduino -b 115200 -P /dev/ttyACM0 " + HEX.format("uno/bridge_usb")),
        ("nano /dev/ttyUSB0 Echo",
         "avrdude -p atmega328p -c arduino -b 115200 -P /dev/ttyUSB0 " + HEX.format("uno/Echo")),
        ("nano --old-bootloader /dev/ttyUSB0 Echo",
         "avrdude -p atmega328p -c arduino -b 57600 -P /dev/ttyUSB0 " + HEX.format("uno/Echo")),
        ("leonardo /dev/ttyACM0 Echo",
         "stty -F /dev/ttyACM0 1200 hupcl\n"
         "avrdude -p atmega32u4 -c avr109 -b 57600 -P /dev/ttyACM0 " + HEX.format("leonardo/Echo")),
        ("micro /dev/ttyACM1 bridge_usb",
         "stty -F /dev/ttyACM1 1200 hupcl\n"
         "avrdude -p atmega32u4 -c avr109 -b 57600 -P /dev/ttyACM1 " + HEX.format("leonardo/bridge_usb")),
        ("mega /dev/ttyACM0 Sniffer",
         "avrdude -p atmega2560 -c wiring -b 115200 -P /dev/ttyACM0 " + HEX.format("mega/Sniffer")),
        ("uno /dev/ttyACM0 Own/Own.ino",
         "avrdude -p atmega328p -c arduino -b 115200 -P /dev/ttyACM0 " + HEX.format("own/uno/Own")),
        ("nano /dev/ttyACM0 Own",
         "avrdude -p atmega328p -c arduino -b 115200 -P /dev/ttyACM0 " + HEX.format("own/nano/Own")),
        ("uno /dev/ttyACM0 ./Own/",
         "avrdude -p atmega328p -c arduino -b 115200 -P /dev/ttyACM0 " + HEX.format("own/uno/Own")),
    ]

    def test_lines(self):
        os.mkdir(f"{self.folder}/Own")
        pathlib.Path(self.folder, "Own/Own.ino").touch()
        for words, expected in self.LINES:
            with self.subTest(words):
                self.assertEqual(self.flash("--dry-run", *words.split()), (0, expected, []))

    def test_ready_images(self):
        elf = f"{BUILD}/firmware/uno/bridge_usb.elf"
        hex_file = f"{self.folder}/Ready.hex"
        subprocess.run(["avr-objcopy", "-O", "ihex", elf, hex_file], check=True)
        line = "avrdude -p atmega328p -c arduino -b 115200 -P /dev/x -D -U flash:w:{}:i\n"
        self.assertEqual(self.flash("--dry-run", "uno", "/dev/x", elf),
                         (0, line.format("build/release/firmware/ready/bridge_usb.hex"), []))
        self.assertEqual(self.flash("--dry-run", "uno", "/dev/x", "Ready.hex"), (0, line.format(hex_file), []))

    def test_help(self):
        status, out, said = self.flash("--help")
        self.assertEqual((status, said), (0, []))
        self.assertTrue(out.startswith("usage: scripts/flash [OPTION...] BOARD PORT SKETCH\n"))


class RefusalTest(FlashTest):
    # command line, exit status, what it says
    LINES = [
        ("", 2, "expected BOARD PORT SKETCH, such as: uno /dev/ttyACM0 bridge_usb; scripts/flash --help "
                "says more"),
        ("uno /dev/null", 2, "expected BOARD PORT SKETCH, such as: uno /dev/ttyACM0 bridge_usb; "
                             "scripts/flash --help says more"),
        ("due /dev/null Echo", 2, "board 'due': expected uno, nano, leonardo, micro or mega"),
        ("--fast uno /dev/null Echo", 2, "unknown option '--fast'; scripts/flash --help shows which there are"),
        ("uno /dev/null Echo --build", 2, "--build: expected a folder after it"),
        ("--old-bootloader mega /dev/null Echo", 2, "--old-bootloader is for uno and nano, not for mega"),
        ("uno /dev/null echo", 2, f"sketch 'echo': expected {SKETCHES}, a sketch's folder or .ino, or a ready "
                                  ".elf or .hex"),
        ("uno /dev/null Other", 2, "FOLDER/Other: expected the sketch Other.ino in this folder"),
        ("uno /dev/null Nosuch.ino", 2, "FOLDER/Nosuch.ino: no such file"),
        ("uno /dev/null Other/Own.ino", 2,
         "FOLDER/Other/Own.ino: expected it in a folder of its name, Own/Own.ino"),
        # ready images
        ("uno /dev/null Nosuch.elf", 2, "Nosuch.elf: no such file"),
        ("uno /dev/null text.elf", 2, "FOLDER/text.elf: is not an ELF file for an AVR"),
        ("uno /dev/null text.hex", 2, "FOLDER/text.hex: is not an Intel HEX file"),
        ("uno /dev/null BUILD/firmware/mega/bridge_usb.elf", 2,
         "BUILD/firmware/mega/bridge_usb.elf: is for an atmega2560, but a uno has an atmega328p"),
        ("--dry-run micro /dev/null BUILD/firmware/uno/bridge_usb.elf", 2,
         "BUILD/firmware/uno/bridge_usb.elf: is for an atmega328p, but a micro has an atmega32u4"),
        # the port, once there is something for it
        ("uno /nosuch/ttyACM9 BUILD/firmware/uno/bridge_usb.elf", 1,
         "no port /nosuch/ttyACM9: is the board plugged in? (ls /dev/ttyACM* /dev/ttyUSB*)"),
        ("uno Other/Own.ino BUILD/firmware/uno/bridge_usb.elf", 1,
         "no port Other/Own.ino: is the board plugged in? (ls /dev/ttyACM* /dev/ttyUSB*)"),
        ("uno FOLDER/Other/Own.ino BUILD/firmware/uno/bridge_usb.elf", 1,
         "FOLDER/Other/Own.ino is no serial port"),
    ]

    def test_each_is_one_line(self):
        os.mkdir(f"{self.folder}/Other")
        pathlib.Path(self.folder, "Other/Own.ino").touch()
        for name in ("text.elf", "text.hex"):
            pathlib.Path(self.folder, name).write_text("no firmware\n")
        for words, status, expected in self.LINES:
            with self.subTest(words):
                words, expected = (text.replace("FOLDER", self.folder).replace("BUILD", BUILD)
                                   for text in (words, expected))
                self.assertEqual(self.flash("--build", f"{self.folder}/build", *words.split()),
                                 (status, "", ["flash: " + expected]))
                self.assertEqual(self.all_said.count("\n"), 1)

    def test_no_avrdude(self):
        for tool in ("bash", "basename", "dirname", "ls", "readlink"):
            os.symlink(f"/usr/bin/{tool}", f"{self.folder}/{tool}")
        self.assertEqual(
            self.flash("uno", "/dev/null", "Echo", env={"PATH": self.folder}),
            (1, "", ["flash: avrdude is missing; Debian has it in the package avrdude: sudo apt-get install "
                     "avrdude"]))


class FakeAvrdudeTest(FlashTest):
    def setUp(self):
        super().setUp()
        self.fake = f"{self.folder}/avrdude"
        pathlib.Path(self.fake).write_text(FAKE)
        os.chmod(self.fake, 0o755)
        self.env = dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}",
                        XDG_CACHE_HOME=f"{self.folder}/cache")

    def arguments(self):
        return pathlib.Path(self.fake + ".arguments").read_text().split("\n")[:-1]

    def test_it_is_asked_once_the_image_is_built(self):
        result = self.flash("--build", BUILD, "uno", "/dev/null", "bridge_usb", env=self.env)
        self.assertEqual(result, (0, "", ["flash: building bridge_usb for uno ...",
                                          "flash: /dev/null: uno has bridge_usb"]))
        self.assertEqual(self.arguments(), [
            "-p", "atmega328p", "-c", "arduino", "-b", "115200", "-P", "/dev/null", "-D", "-U",
            f"flash:w:{BUILD}/firmware/uno/bridge_usb.hex:i"])

    def test_a_sketch_of_ones_own(self):
        os.mkdir(f"{self.folder}/Own")
        pathlib.Path(self.folder, "Own/Own.ino").write_text(
            "#include <Roio.h>\nRoioOn<10> roio;\nvoid setup() { roio.begin(500, 2, 0); }\nvoid loop() {}\n")
        status, _, said = self.flash("--build", BUILD, "nano", "/dev/null", "Own/Own.ino", env=self.env)
        self.assertEqual((status, said), (0, ["flash: building Own for nano ...",
                                              "flash: /dev/null: nano has Own"]))
        self.assertEqual(self.arguments()[-1], f"flash:w:{BUILD}/firmware/own/nano/Own.hex:i")

    def test_it_builds_before_it_looks_for_the_port(self):
        status, _, said = self.flash("--build", BUILD, "uno", "/nosuch/ttyACM9", "bridge_usb", env=self.env)
        self.assertEqual((status, said), (1, [
            "flash: building bridge_usb for uno ...",
            "flash: no port /nosuch/ttyACM9: is the board plugged in? (ls /dev/ttyACM* /dev/ttyUSB*)"]))

    def test_a_ready_image(self):
        elf = f"{BUILD}/firmware/uno/bridge_usb.elf"
        status, _, said = self.flash("--build", f"{self.folder}/build", "uno", "/dev/null", elf, env=self.env)
        self.assertEqual((status, said), (0, ["flash: /dev/null: uno has bridge_usb"]))
        self.assertEqual(self.arguments()[-1], f"flash:w:{self.folder}/build/firmware/ready/bridge_usb.hex:i")

    def test_a_sketch_that_does_not_compile(self):
        os.mkdir(f"{self.folder}/Own")
        pathlib.Path(self.folder, "Own/Own.ino").write_text("void setup() { nonsense(); }\nvoid loop() {}\n")
        status, _, said = self.flash("--build", BUILD, "uno", "/dev/null", "Own/Own.ino", env=self.env)
        self.assertEqual((status, said), (1, ["flash: building Own for uno ...",
                                              f"flash: {self.folder}/Own/Own.ino does not build for uno"]))
        self.assertRegex(self.all_said, "error: .nonsense. was not declared in this scope")
        self.assertFalse(os.path.exists(self.fake + ".arguments"))

    def test_a_board_that_does_not_answer(self):
        self.env["FAKE_STATUS"] = "1"
        status, _, said = self.flash("--build", BUILD, "mega", "/dev/null", "bridge_usb", env=self.env)
        self.assertEqual((status, said), (1, [
            "flash: building bridge_usb for mega ...",
            "flash: /dev/null: the board did not take it. Is it a mega, and has no other program the port "
            "open?"]))

    def test_a_port_that_cannot_be_touched(self):
        status, _, said = self.flash("--build", BUILD, "leonardo", "/dev/null", "bridge_usb", env=self.env)
        self.assertEqual((status, said), (1, [
            "flash: building bridge_usb for leonardo ...",
            "flash: /dev/null cannot be set to 1200 bit/s: does another program have it open?"]))


class AvrdudeTest(FlashTest):
    """The real one, and boards that are real as far as it can see."""

    def check(self, board, kind, port, bootloader):
        result = self.flash("--build", BUILD, board, port, "bridge_usb")
        self.assertEqual(result[0], 0, self.all_said)
        self.assertEqual(bootloader.image()[:len(image_of(kind))], image_of(kind))
        bootloader.thread.join(GUARD)
        self.assertTrue(bootloader.done)

    def test_uno(self):
        board = self.port(Optiboot(b"\x1e\x95\x0f", termios.B115200))
        self.check("uno", "uno", board.path, board)

    def test_mega(self):
        board = self.port(Stk500v2(b"\x1e\x98\x01", termios.B115200))
        self.check("mega", "mega", board.path, board)

    def test_leonardo(self):
        board = self.port(Caterina(b"\x1e\x95\x87", termios.B57600))
        port = self.port(TouchedPort(self.folder, "ttyACM0", "ttyACM1", board))
        self.check("leonardo", "leonardo", port.before, board)

    def test_another_board_than_was_said(self):
        board = self.port(Optiboot(b"\x1e\x94\x06", termios.B115200))  # an ATmega168
        status, _, said = self.flash("--build", BUILD, "uno", board.path, "bridge_usb")
        self.assertEqual((status, said[1:]), (1, [
            f"flash: {board.path}: the board did not take it. Is it a uno, and has no other program the port "
            "open?"]))
        self.assertEqual(board.image(), b"")


if __name__ == "__main__":
    unittest.main()
