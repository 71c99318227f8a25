#!/usr/bin/env python3
"""`roio-cli ask`: the answer that came after the question, and no other."""

import signal
import subprocess

from driver import CLI, GUARD, main
from live_driver import LiveTest

BUS = "local:robot"


class AskTest(LiveTest):
    def ask(self, *arguments):
        """An ask that has sent its question, which is in the second value, as dump shows it."""
        dump = self.dump("-n", "1", BUS, "from=0.10")
        ask = subprocess.Popen([CLI, "ask", "--timeout", "60000", *arguments], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(ask.kill)
        status, question, _ = dump.result()
        self.assertEqual(status, 0)
        return ask, question

    def ended(self, ask):
        out, err = ask.communicate(timeout=GUARD)
        return ask.returncode, out, err

    def answer(self, data, source="0.2", destination="0.10"):
        self.send("--from", source, BUS, destination, data)

    def test_the_question_is_sent_and_the_answer_printed(self):
        for words, question in (
                (["0.2", "5A2D00"], "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"),
                (["0.2"], "0.10   -> 0.2     normal  message  [0]\n"),
                (["--urgent", "--class", "system", "0.2", "--dec", "90", "45"],
                 "0.10   -> 0.2     urgent  system   [2]  5A 2D\n")):
            with self.subTest(words):
                options = [word for word in words[:-1] if word.startswith("--") or word == "system"]
                ask, sent = self.ask(BUS, *words)
                self.assertEqual(sent, question, options)
                self.answer("01")
                self.assertEqual(self.ended(ask), (0, "0.2    -> 0.10    normal  message  [1]  01\n", ""))

    def test_what_is_no_answer_is_passed_over(self):
        ask, _ = self.ask(BUS, "0.2", "01")
        self.answer("A1", source="0.3")
        self.answer("A2", destination="0.11")
        self.answer("A3", destination="0.*")
        self.answer("A4", source="1.2")
        self.send(BUS, "123#A5")
        self.answer("01")
        self.assertEqual(self.ended(ask), (0, "0.2    -> 0.10    normal  message  [1]  01\n", ""))

    def test_of_two_answers_the_first_is_printed(self):
        ask, _ = self.ask(BUS, "0.2", "01")
        self.send(BUS, "-", stdin="(1.0) x 10014002#01\n(1.0) x 10014002#02\n")
        self.assertEqual(self.ended(ask), (0, "0.2    -> 0.10    normal  message  [1]  01\n", ""))

    def test_a_broadcast_is_answered_by_anybody_there(self):
        ask, question = self.ask(BUS, "0.*", "01")
        self.assertIn(" -> 0.* ", question)
        self.answer("A1", source="1.3")
        self.answer("02", source="0.77")
        self.assertEqual(self.ended(ask), (0, "0.77   -> 0.10    normal  message  [1]  02\n", ""))

    def test_the_answer_as_json(self):
        ask, _ = self.ask("--json", BUS, "0.2", "01")
        self.answer("0203")
        status, out, err = self.ended(ask)
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, r'^\{"type":"Roio",.*"data":\[2,3\],"source":"0\.2",.*\}\n$')

    def test_none_in_time_is_failure(self):
        self.dump(BUS)
        self.assertEqual(self.run_cli("ask", "--timeout", "50", BUS, "0.2", "01"),
                         (1, "", "roio-cli: local:robot: no answer from 0.2 within 50 ms\n"))

    def test_with_nobody_there_it_says_so(self):
        self.assertEqual(
            self.run_cli("ask", "--timeout", "50", BUS, "0.2", "01"),
            (1, "", "roio-cli: local:robot: no answer from 0.2 within 50 ms: nobody else is on the bus\n"))

    def test_what_came_before_the_question_is_no_answer(self):
        # Answers without end, all of them before: the last is sent before ask begins.
        listener = self.dump(BUS)
        for number in range(5):
            self.answer(f"{number:02X}")
        self.assertEqual(self.run_cli("ask", "--timeout", "50", BUS, "0.2", "01")[0], 1)
        self.assertIsNone(listener.process.poll())

    def test_a_late_answer_is_nobodys(self):
        listener = self.dump(BUS)
        self.assertEqual(self.run_cli("ask", "--timeout", "20", BUS, "0.2", "01")[0], 1)
        self.answer("01")
        ask, _ = self.ask(BUS, "0.2", "02")
        self.answer("02")
        self.assertEqual(self.ended(ask), (0, "0.2    -> 0.10    normal  message  [1]  02\n", ""))
        self.assertIsNone(listener.process.poll())

    def test_signals_end_it(self):
        ask, _ = self.ask(BUS, "0.2", "01")
        ask.send_signal(signal.SIGINT)
        self.assertEqual(self.ended(ask), (128 + signal.SIGINT, "", ""))

    def test_a_bus_that_stands_still_is_told(self):
        listener = self.dump(BUS)
        other = self.dump(BUS)
        listener.process.send_signal(signal.SIGSTOP)
        self.addCleanup(listener.process.send_signal, signal.SIGCONT)
        status, out, err = self.run_cli("ask", "--timeout", "300", BUS, "0.2", "01")
        self.assertEqual((status, out), (1, ""), err)
        self.assertIsNone(other.process.poll())


if __name__ == "__main__":
    main()
