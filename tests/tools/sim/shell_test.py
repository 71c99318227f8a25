#!/usr/bin/env python3
"""The manual page and the completions: right in themselves, and complete against the program's help."""

import os
import re
import subprocess

from driver import GUARD
from sim_driver import SimTest, main

TOOL = os.environ["ROIO_SIM_SOURCES"]


def read(*path):
    with open(os.path.join(TOOL, *path)) as file:
        return file.read()


class SyncTest(SimTest):
    def options(self):
        help_text = self.run_sim("--help")[1]
        found = set(re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", help_text))
        self.assertIn("--help", found)
        return found - {"--help", "--version"}

    def test_the_manual_page_describes_every_option(self):
        described = set()
        for flag in re.findall(r"(?m)^\.It (Fl .*)$", read("man", "roio-sim.1")):
            described |= {part.replace("Fl Fl ", "--").split()[0] for part in flag.split(" , ")}
        self.assertEqual({name for name in described if name.startswith("--")}, self.options())

    def test_completions_offer_every_option(self):
        expected = self.options() | {"--help", "--version"}
        bash = re.search(r"-\*\) echo (.*); return", read("completions", "roio-sim.bash"))[1]
        self.assertEqual(set(bash.split()), expected)
        zsh = read("completions", "_roio-sim")
        self.assertEqual(set(re.findall(r"(--[\w-]+)[\[}]", zsh)), expected)
        fish = re.findall(r"complete -c roio-sim (?:-s \w )?-l ([\w-]+)", read("completions",
                                                                               "roio-sim.fish"))
        self.assertEqual({"--" + name for name in fish}, expected)

    def test_the_manual_page_describes_every_command(self):
        page = read("man", "roio-sim.1")
        described = set(re.findall(r"Cm (press|hold|release|pin|analog|serial|reset|unplug|plug|wait|help"
                                   r"|quit)\b", page)) | set(re.findall(r"Cm help , (quit)", page))
        commands = self.run_sim("--help")[1].split("Commands, a line each")[1]
        self.assertEqual(
            set(re.findall(r"(?m)(?:^|, )NAME (\w+)|^(?:wait|quit)", commands)) - {""} |
            {"release", "wait", "quit", "help"}, described)


class ManualTest(SimTest):
    def test_the_page_is_clean(self):
        done = subprocess.run(
            ["mandoc", "-Tlint", "-Wwarning", os.path.join(TOOL, "man", "roio-sim.1")],
            capture_output=True, text=True, timeout=GUARD)
        self.assertEqual((done.returncode, done.stdout), (0, ""))


class CompletionTest(SimTest):
    # command line, what is offered
    LINES = [
        ("roio-sim u", ["uno="]),
        ("roio-sim m", ["mega=", "micro="]),
        ("roio-sim n", ["nano="]),
        ("roio-sim arm:l", ["arm:leonardo="]),
        ("roio-sim arm:uno=Ar", ["arm:uno=Arm.elf", "arm:uno=Arm.ino"]),
        ("roio-sim --js", ["--json"]),
        ("roio-sim --bus lo", ["local:robot"]),
        ("roio-sim --speed ", ["max"]),
    ]

    def setUp(self):
        super().setUp()
        self.dump("local:robot")  # a bus to be offered
        for name in ("Arm.elf", "Arm.hex", "Arm.ino"):
            open(self.path(name), "w").close()

    def run_shell(self, *command):
        done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return sorted(done.stdout.split("\n")[:-1])

    def test_bash(self):
        script = r"""
          source "$1"; line=$2
          # The words as readline cuts them: at spaces, ':' and '='.
          mapfile -t COMP_WORDS < <(grep -oE '[:=]+|[^ :=]+' <<<"$line")
          [[ $line == *' ' ]] && COMP_WORDS+=('')
          COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
          _roio_sim
          [ ${#COMPREPLY[@]} -eq 0 ] || printf '%s\n' "${COMPREPLY[@]}"
        """
        file = os.path.join(TOOL, "completions", "roio-sim.bash")
        for line, offered in self.LINES:
            with self.subTest(line):
                last = line.split(" ")[-1]
                kept = last[: max(last.rfind(":"), last.rfind("=")) + 1]
                self.assertEqual(
                    self.run_shell("bash", "--norc", "-c", script, "bash", file, line),
                    [word[len(kept):] for word in offered])

    def test_fish(self):
        file = os.path.join(TOOL, "completions", "roio-sim.fish")
        self.run_shell("fish", "--no-execute", file)
        for line, offered in self.LINES:
            with self.subTest(line):
                lines = self.run_shell("fish", "--no-config", "-c",
                                       f'source {file}; complete -C "{line}"')
                self.assertEqual([text.split("\t")[0] for text in lines], offered)

    def test_zsh(self):
        self.run_shell("zsh", "-n", os.path.join(TOOL, "completions", "_roio-sim"))


if __name__ == "__main__":
    main()
