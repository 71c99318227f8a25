#!/usr/bin/env python3
"""What docs/roio-sim.md begins with: the library's own examples on two boards, and roio-cli."""

import os

from sim_driver import SimTest, main

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


if __name__ == "__main__":
    main()
