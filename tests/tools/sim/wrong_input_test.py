#!/usr/bin/env python3
"""Wrong command lines: each is one line on standard error that says what was expected, and exit 2."""

import os
import re

from sim_driver import LEONARDO, UNO, SimTest, main

HELP = "; `roio-sim --help` shows how"

# command line (UNO and LEONARDO stand for images), the line on standard error
WRONG = [
    ("", "expected a board: [NAME:]BOARD=FILE" + HELP),
    ("--bsu local:x uno=UNO", 'unknown option "--bsu"' + HELP),
    ("--bus", "--bus: expected a value after it"),
    # boards
    ("UNO", 'board "UNO": expected [NAME:]BOARD=FILE, such as fan:uno=Fan/Fan.ino'),
    ("uno=", 'board "uno=": expected [NAME:]BOARD=FILE, such as fan:uno=Fan/Fan.ino'),
    ("due=UNO", 'board "due=UNO": expected uno, nano, leonardo, micro or mega before the \'=\', found "due"'),
    ("arm:=UNO", 'board "arm:=UNO": expected uno, nano, leonardo, micro or mega before the \'=\', found ""'),
    (":uno=UNO", 'board ":uno=UNO": expected a name of 1 to 32 letters, digits, \'.\', \'_\' or \'-\' '
                 "before the colon"),
    ("wait:uno=UNO", 'board "wait:uno=UNO": expected another name than "wait", which is a command\'s'),
    ("a:uno=UNO a:uno=UNO", 'board "a:uno=UNO": expected another name, "a" is taken'),
    ("--for 1 uno=nosuch.elf", "nosuch.elf: no such file"),
    ("--for 1 uno=TEXT", "TEXT: is not an ELF file"),
    ("--for 1 uno=nosuch.ino", "nosuch.ino: no such file"),
    ("--for 1 nano=LEONARDO", "LEONARDO: is for an atmega32u4, but a Uno has an atmega328p"),
    ("--for 1 uno=LEONARDO", "LEONARDO: is for an atmega32u4, but a Uno has an atmega328p"),
    # options that are there once
    ("--rate 5000 --rate 6000 uno=UNO", '--rate: expected once, found "5000" and "6000"'),
    ("--bus=can0 --bus=can1 uno=UNO", '--bus: expected once, found "can0" and "can1"'),
    ("--for 1 --for 2 uno=UNO", '--for: expected once, found "1" and "2"'),
    ("--speed 1 --speed max uno=UNO", '--speed: expected once, found "1" and "max"'),
    # the bus
    ("--bus EMPTY uno=UNO", 'bus "": empty; expected an interface such as can0, local:NAME or '
                            "serial:DEVICE"),
    ("--rate EMPTY uno=UNO", '--rate: expected a whole number 5000..1000000, found ""'),
    ("--bus local: uno=UNO", 'bus "local:": a bus name of 0 bytes; expected 1..64, such as robot'),
    ("--rate fast uno=UNO", '--rate: expected a whole number 5000..1000000, found "fast"'),
    ("--rate 4999 uno=UNO", '--rate: expected a whole number 5000..1000000, found "4999"'),
    ("--rate 1000001 uno=UNO", '--rate: expected a whole number 5000..1000000, found "1000001"'),
    # time
    ("--speed 0 uno=UNO", '--speed: expected 0.001..1000 or max, found "0"'),
    ("--speed 1x uno=UNO", '--speed: expected 0.001..1000 or max, found "1x"'),
    ("--for 0 uno=UNO", "--for: expected seconds, above 0 and at most 1000000, such as 0.25, found "
                        '"0"'),
    ("--for EMPTY uno=UNO", "--for: expected seconds, above 0 and at most 1000000, such as 0.25, found "
                            '""'),
    ("--for nan uno=UNO", "--for: expected seconds, above 0 and at most 1000000, such as 0.25, found "
                          '"nan"'),
    # pins and crystals
    ("--cs arm:9 uno=UNO", '--cs: no board "arm"; there is uno'),
    ("--cs :9 uno=UNO", '--cs: no board ""; there is uno'),
    ("--cs EMPTY uno=UNO", "--cs: expected a pin such as 4 or A0"),
    ("--cs uno:A9 uno=UNO", "--cs: uno: a Uno has no analog input A9"),
    ("--cs 20 uno=UNO", "--cs: uno: a Uno has no pin 20"),
    ("--cs 13 uno=UNO", "uno: chip select cannot be on pin 13, which is SPI's SCK on a Uno"),
    ("--cs 2 uno=UNO", "uno: chip select and INT cannot both be on pin 2"),
    ("--int nowhere uno=UNO", '--int: expected none, or a pin such as 3 or A0, found "nowhere"'),
    ("--int 20 uno=UNO", "--int: uno: a Uno has no pin 20"),
    ("--int 10 uno=UNO", "uno: chip select and INT cannot both be on pin 10"),
    ("--int uno:D12 uno=UNO", "uno: INT cannot be on pin 12, which is SPI's MISO on a Uno"),
    ("--crystal 16 uno=UNO", '--crystal: expected a whole number 1000000..40000000, found "16"'),
    ("--serial-pty arm uno=UNO", '--serial-pty: no board "arm"; there is uno'),
    ("--serial-pty /dev/ttyACM0 uno=UNO", '--serial-pty: no board "/dev/ttyACM0"; there is uno'),
    ("--serial-pty EMPTY uno=UNO", '--serial-pty: expected NAME or NAME:PATH, found ""'),
    ("--serial-pty :x uno=UNO", '--serial-pty: expected NAME or NAME:PATH, found ":x"'),
    ("--serial-pty uno: uno=UNO", '--serial-pty: expected NAME or NAME:PATH, found "uno:"'),
    ("--serial-pty a:x --serial-pty b:x a:uno=UNO b:uno=UNO",
     '--serial-pty: expected another path for "b:x", this one is for a'),
    ("--serial-pty uno:no/such uno=UNO", "--serial-pty: no/such: No such file or directory"),
    # commands
    ("--do quti uno=UNO", '--do "quti": expected a board\'s name and press, hold, release, pin, analog, '
                          'serial, reset, unplug or plug; or wait, help or quit, found "quti"'),
    ("--do EMPTY uno=UNO", '--do "": expected a board\'s name and press, hold, release, pin, analog, serial, '
                           "reset, unplug or plug; or wait, help or quit"),
    ("--do press_4 uno=UNO", '--do "press 4": expected a board\'s name first: NAME press 4'),
    ("--do serial_hello uno=UNO", '--do "serial hello": expected a board\'s name first: NAME serial hello'),
    ("--do uno_pin_2_high uno=UNO", "--do: uno: pin 2 is driven by the chip, whose INT is there; see --int"),
    ("--do arm_reset uno=UNO", '--do: no board "arm"; there is uno'),
    ("--do uno_press_20 uno=UNO", "--do: a Uno has no pin 20"),
    ("--do uno_plug_serial uno=UNO", "--do: uno: its serial port is no terminal; see --serial-pty"),
]


class WrongInputTest(SimTest):
    def test_each_is_one_line_and_exit_2(self):
        os.symlink(UNO, self.path("UNO"))
        os.symlink(LEONARDO, self.path("LEONARDO"))
        with open(self.path("TEXT"), "w") as file:
            file.write("no firmware\n")
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        for command_line, expected in WRONG:
            with self.subTest(command_line):
                # In commands, "_" is a blank.
                words = ["" if word == "EMPTY" else
                         re.sub("_(?=reset|press|[0-9]|plug|serial|pin|high|hello)", " ", word)
                         for word in command_line.split()]
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
        self.assertEqual(err, f"roio-sim: {self.path('text.elf')}: is not an ELF file\n")


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
            self.assertLessEqual(max(map(len, out.splitlines())), 80)


if __name__ == "__main__":
    main()
