#!/usr/bin/env python3
"""What docs/roio-sim.md shows: the library's own examples on two boards, and roio-cli; and a bridge on a
serial port."""

import os
import select
import termios
import tty

from sim_driver import GUARD, SimTest, main

IMAGES = os.path.join(os.environ["ROIO_SIM_IMAGES"], "uno")


class ExamplesTest(SimTest):
    def test_an_arm_and_its_sensors(self):
        sim = self.sim("--bus", "local:robot", "arm:uno=" + os.path.join(IMAGES, "ServoController.elf"),
                       "sensors:uno=" + os.path.join(IMAGES, "SensorBoard.elf"))
        sim.wait_for("arm: can: normal, 500000 bit/s", "sensors: can: normal, 500000 bit/s",
                     *[f"arm: servo: pin {pin} at 45 degrees" for pin in (3, 5, 6)])
        self.send("local:robot", "0.2", "5A2D00")
        sim.wait_for("arm: servo: pin 3 at 90 degrees", "arm: servo: pin 6 at 0 degrees")
        # The first button, clicked once: [light, clicks, clicks, potentiometers]. In its first 200 ms,
        # the program takes no click.
        dump = self.dump("-n", "1", "local:robot", "from=0.3")
        sim.say("wait 0.3", "sensors press 4")
        self.assertEqual(dump.line(),
                         "0.3    -> 0.10    normal  message  [6]  00 01 00 00 00 00\n")
        sim.say("quit")
        status, _, err = sim.result()
        self.assertEqual((status, err), (0, ""))


    def test_a_bridge_on_a_serial_port(self):
        link = self.path("ttyACM0")
        sim = self.sim("--serial-pty", "usb:" + link, "--crystal", "usb:8000000",
                       "usb:uno=" + os.path.join(IMAGES, "bridge_usb.elf"),
                       "arm:uno=" + os.path.join(IMAGES, "ServoController.elf"))
        sim.wait_for("usb: can: normal, 500000 bit/s",
                     *[f"arm: servo: pin {pin} at 45 degrees" for pin in (3, 5, 6)])
        port = os.open(link, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, port)
        tty.setraw(port)
        settings = termios.tcgetattr(port)
        settings[4:6] = termios.B115200, termios.B115200
        termios.tcsetattr(port, termios.TCSANOW, settings)
        # SLCAN: closed, 500 kbit/s, open; 90 45 0 degrees to 0.2; how many were refused?
        for line, answer in ((b"C", b"\r"), (b"S6", b"\r"), (b"O", b"\r"), (b"T1000400A35A2D00", b"Z\r"),
                             (b"T1000400A0", b"Z\rT1001400220000\r")):
            os.write(port, line + b"\r")
            seen = b""
            while len(seen) < len(answer):
                self.assertNotEqual(select.select([port], [], [], GUARD)[0], [], (line, seen))
                seen += os.read(port, 100)
            self.assertEqual(seen, answer)
        sim.wait_for("arm: servo: pin 3 at 90 degrees", "arm: servo: pin 6 at 0 degrees")
        sim.say("quit")
        status, _, err = sim.result()
        self.assertEqual((status, err), (0, ""))


if __name__ == "__main__":
    main()
