#!/usr/bin/env python3
"""Wrong command lines: each is one line on standard error that says what was expected, and exit 2."""

import os
import re

from sim_driver import LEONARDO, UNO, SimTest, main

HELP = "; `roio-sim --help` shows how"

# command line (UNO and LEONARDO stand for images), the line on standard error
WRONG = [
    ("", "expected a board: [NAME:]BOARD=ELF" + HELP),
    ("--bsu local:x uno=UNO", 'unknown option "--bsu"' + HELP),
    ("--bus", "--bus: expected a value after it"),
    # boards
    ("UNO", 'board "UNO": expected [NAME:]BOARD=ELF, such as arm:uno=ServoController.elf'),
    ("uno=", 'board "uno=": expected [NAME:]BOARD=ELF, such as arm:uno=ServoController.elf'),
    ("nano=UNO", 'board "nano=UNO": expected uno, leonardo, micro or mega before the \'=\', found "nano"'),
    ("arm:=UNO", 'board "arm:=UNO": expected uno, leonardo, micro or mega before the \'=\', found ""'),
    (":uno=UNO", 'board ":uno=UNO": expected a name of 1 to 32 letters, digits, \'.\', \'_\' or \'-\' '
                 "before the colon"),
    ("wait:uno=UNO", 'board "wait:uno=UNO": expected another name than "wait", which is a command\'s'),
    ("a:uno=UNO a:uno=UNO", 'board "a:uno=UNO": expected another name, "a" is taken'),
    ("--for 1 uno=nosuch.elf", "nosuch.elf: no such file"),
    ("--for 1 uno=LEONARDO", "LEONARDO: is for an atmega32u4, but a Uno has an atmega328p"),
    # the bus
    ("--bus local: uno=UNO", 'bus "local:": a bus name of 0 bytes; expected 1..64, such as robot'),
    ("--rate fast uno=UNO", '--rate: expected a whole number 5000..1000000, found "fast"'),
    ("--rate 4999 uno=UNO", '--rate: expected a whole number 5000..1000000, found "4999"'),
    ("--rate 1000001 uno=UNO", '--rate: expected a whole number 5000..1000000, found "1000001"'),
    # time
    ("--speed 0 uno=UNO", '--speed: expected 0.001..1000 or max, found "0"'),
    ("--speed 1x uno=UNO", '--speed: expected 0.001..1000 or max, found "1x"'),
    ("--for 0 uno=UNO", "--for: expected seconds, above 0 and at most 1000000, such as 0.25, found "
                        '"0"'),
    ("--for nan uno=UNO", "--for: expected seconds, above 0 and at most 1000000, such as 0.25, found "
                          '"nan"'),
    # pins and crystals
    ("--cs arm:9 uno=UNO", '--cs: no board "arm"; there is uno'),
    ("--cs uno:A9 uno=UNO", '--cs: expected a whole number 0..99, found "A9"'),
    ("--cs 20 uno=UNO", "uno: a Uno has no pin 20"),
    ("--int nowhere uno=UNO", '--int: expected none, or a whole number 0..99, found "nowhere"'),
    ("--int 20 uno=UNO", "uno: a Uno has no pin 20"),
    ("--crystal 16 uno=UNO", '--crystal: expected a whole number 1000000..40000000, found "16"'),
    ("--serial-pty arm uno=UNO", '--serial-pty: no board "arm"; there is uno'),
    ("--serial-pty /dev/ttyACM0 uno=UNO", '--serial-pty: no board "/dev/ttyACM0"; there is uno'),
    ("--serial-pty uno: uno=UNO", '--serial-pty: expected NAME or NAME:PATH, found "uno:"'),
    ("--serial-pty a:x --serial-pty b:x a:uno=UNO b:uno=UNO",
     '--serial-pty: expected another path for "b:x", this one is for a'),
    ("--serial-pty uno:no/such uno=UNO", "--serial-pty: no/such: No such file or directory"),
    # commands
    ("--do quti uno=UNO", '--do "quti": expected press, hold, release, pin, analog, serial, reset, '
                          "unplug or plug"),
    ("--do arm_reset uno=UNO", '--do: no board "arm"; there is uno'),
    ("--do uno_press_20 uno=UNO", "--do: a Uno has no pin 20"),
    ("--do uno_plug_serial uno=UNO", "--do: uno: its serial port is no terminal; see --serial-pty"),
]


class WrongInputTest(SimTest):
    def test_each_is_one_line_and_exit_2(self):
        os.symlink(UNO, self.path("UNO"))
        os.symlink(LEONARDO, self.path("LEONARDO"))
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        for command_line, expected in WRONG:
            with self.subTest(command_line):
                # In commands, "_" is a blank.
                words = [re.sub("_(?=reset|press|20|plug|serial)", " ", word) for word in command_line.split()]
                self.assertEqual(self.run_sim(*words), (2, "", "roio-sim: " + expected + "\n"))

    def test_a_bus_at_another_bit_rate(self):
        self.dump("local:paced?bitrate=250000")
        status, out, err = self.run_sim("--bus", "local:paced?bitrate=500000", "uno=" + UNO)
        self.assertEqual((status, out), (2, ""))
        self.assertEqual(
            err, "roio-sim: local:paced?bitrate=500000 (it runs at 250000 bit/s): not the pace of this "
                 "bus; its name alone, without bitrate, joins it as it is\n")

    def test_a_file_that_is_no_firmware(self):
        with open(self.path("text.elf"), "w") as file:
            file.write("no firmware\n")
        status, out, err = self.run_sim("uno=" + self.path("text.elf"))
        self.assertEqual((status, out), (2, ""))
        self.assertRegex(err, rf"^roio-sim: {self.path('text.elf')}: [^\n]*\n$")


class InformationTest(SimTest):
    def test_version(self):
        status, out, err = self.run_sim("--version")
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r"^roio-sim \d+\.\d+\.\d+\n$")

    def test_help(self):
        for option in ("--help", "-h"):
            status, out, err = self.run_sim(option)
            self.assertEqual((status, err), (0, ""))
            self.assertIn("Usage: roio-sim ", out)
            self.assertIn("Examples:\n  roio-sim ", out)
            self.assertLess(max(map(len, out.splitlines())), 100)


if __name__ == "__main__":
    main()
