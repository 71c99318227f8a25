#!/usr/bin/python3
"""top, gen, ask and attach on real SocketCAN. Runs in scripts/lab."""

import json
import signal
import subprocess

from driver import CLI, GUARD, main
from live_driver import LiveTest

IN_ORDER = "2000 received, from number 0, 0 lost, 0 doubled, 0 out of order\n"


def ip(*arguments):
    subprocess.run(["ip", "link", *arguments], check=True, timeout=GUARD)


class SocketCanTest(LiveTest):
    def attach(self, *arguments):
        attach = self.running("attach", *arguments)
        self.assertIn(": attached to ", attach.first)
        return attach

    def flood(self, near, far):
        check = self.running("gen", "--check", "-v", "--count", "2000", far)
        status, _, err = self.run_cli("gen", "--rate", "2000", "--count", "2000", "--id", "7", near)
        self.assertEqual(status, 0, err)
        self.assertEqual(check.end(), (0, "0.10 #7: " + IN_ORDER, ""))

    def test_an_interface_and_a_local_bus_become_one_and_no_ring(self):
        ip("add", "vcan5", "type", "vcan")
        self.addCleanup(ip, "delete", "vcan5")
        ip("set", "vcan5", "up")
        first = self.attach("-v", "vcan0", "vcan5")
        self.attach("vcan5", "local:x")
        status, _, err = self.run_cli("attach", "local:x", "vcan0")
        self.assertEqual((status, "joined already, by way of other buses" in err), (1, True), err)
        self.assertEqual(self.run_cli("attach", "vcan0", "socketcan:vcan0")[0], 2)
        self.flood("vcan0", "local:x")
        self.flood("local:x", "vcan0")
        ip("set", "vcan5", "down")
        first.wait_for("vcan5: bus is down")
        ip("set", "vcan5", "up")
        first.wait_for("vcan5: bus is error-active")
        self.flood("vcan0", "local:x")
        self.assertEqual(first.end(signal.SIGINT)[0], 128 + signal.SIGINT)

    def test_ask_is_answered_by_another_program(self):
        ask = subprocess.Popen([CLI, "ask", "--timeout", "60000", "vcan0", "0.2", "01"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(ask.kill)
        # Until it is there: only the answers after the question count.
        while ask.poll() is None:
            subprocess.run(["cansend", "vcan0", "10014002#07"], check=True, timeout=GUARD)
        self.assertEqual(ask.communicate(timeout=GUARD),
                         ("0.2    -> 0.10    normal  message  [1]  07\n", ""))
        self.assertEqual(ask.returncode, 0)

    def test_top_counts_what_is_sent(self):
        top = subprocess.Popen([CLI, "top", "--interval", "100", "vcan0"], stdout=subprocess.PIPE, text=True)

        def end():
            top.kill()
            top.communicate()

        self.addCleanup(end)
        first = json.loads(top.stdout.readline())
        self.assertEqual((first["bus"], first["bitrate"], first["frames"]), ("vcan0", None, 0))
        self.assertEqual(self.run_cli("gen", "--rate", "8000", "--count", "8000", "vcan0")[0], 0)
        for line in top.stdout:
            facts = json.loads(line)
            if facts["type"] == "bus" and facts["frames"] + facts["lost"] >= 8000:
                break
        self.assertEqual((facts["frames"], facts["lost"]), (8000, 0))


if __name__ == "__main__":
    main()
