#!/usr/bin/env python3
"""Manual pages and completions: right in themselves, and complete against the program's own help."""

import glob
import os
import re
import subprocess

from driver import GUARD, CliTest, main

TOOL = os.environ["ROIO_CLI_SOURCES"]


def read(*path):
    with open(os.path.join(TOOL, *path)) as file:
        return file.read()


COMMANDS = ["send", "ask", "dump", "top", "record", "play", "gen", "buses", "hub", "attach", "bridge show",
            "bridge set", "bridge identify", "bridge attach", "kind header", "kind js", "kind md", "robot dbc",
            "robot check"]


class SyncTest(CliTest):
    def options(self, command):
        """Long options, and short ones that have no long form, as --help prints them."""
        help_text = self.run_cli(*command.split(), "--help")[1]
        found = re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+|-\w)\b", help_text)
        self.assertIn("--help", found)
        return set(found) - {"--help"}

    def section(self, command):
        """What the manual says of a command: a page, or a part of one."""
        page, _, action = command.partition(" ")
        text = read("man", f"roio-cli-{page}.1")
        return re.search(rf"(?sm)^\.Ss {action}$.*?(?=^\.S[sh])", text)[0] if action else text

    def test_manual_pages_describe_every_option(self):
        for command in COMMANDS:
            described = set()
            for flag in re.findall(r"(?m)^\.It (Fl .*)$", self.section(command)):
                for part in flag.split(" , "):
                    words = part.replace("Fl Fl ", "--").replace("Fl ", "-").split()
                    described.add(words[0])
            short = {"-v"} | ({"-o"} if "--output" in described else set())
            self.assertEqual(described - short, self.options(command), command)

    def test_bash_offers_every_option(self):
        text = read("completions", "roio-cli.bash")
        for command in COMMANDS:
            offered = re.search(rf"(?m)^    {command.split()[-1]}:-\*\) echo (.*); return", text)[1]
            self.assertEqual(set(offered.split()) - {"--help"}, self.options(command), command)

    def test_zsh_offers_every_option(self):
        text = read("completions", "_roio-cli")
        for command in COMMANDS:
            name = {"buses": "buses_command"}.get(command, command.replace(" ", "_"))
            part = re.search(rf"(?s)_roio_cli_{name}\(\).*?\n}}", text)[0]
            self.assertEqual(
                set(re.findall(r"(--[\w-]+|(?<![\w-])-\w)(?:=-)?\[", part)) |
                set(re.findall(r"{-\w,(--[\w-]+)}", part)) - {"--help"}, self.options(command),
                command)

    def test_fish_offers_every_option(self):
        text = read("completions", "roio-cli.fish")
        for command in COMMANDS:
            of = ("__roio_cli_" + command if " " in command else
                  "__roio_cli_attach" if command == "attach" else
                  "__fish_seen_subcommand_from " + command)
            found = re.findall(rf"-n '{of}' (?:-s (\w) )?(?:-l ([\w-]+))?", text)
            offered = {"--" + long if long else "-" + short for short, long in found if short or long}
            self.assertEqual(offered, self.options(command), command)


class ManualTest(CliTest):
    def test_pages_are_clean(self):
        pages = sorted(glob.glob(os.path.join(TOOL, "man", "*.1")))
        self.assertEqual(len(pages), 14)
        done = subprocess.run(
            ["mandoc", "-Tlint", "-Wwarning", *pages], capture_output=True, text=True, timeout=GUARD
        )
        self.assertEqual((done.returncode, done.stdout), (0, ""))


class CompletionTest(CliTest):
    def setUp(self):
        super().setUp()
        self.dump("local:robot")  # a bus to be offered

    def run_shell(self, *command):
        done = subprocess.run(command, capture_output=True, text=True, timeout=GUARD)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return sorted(done.stdout.split("\n")[:-1])

    # command line, what is offered: bash replaces what follows the last ':' or '='
    LINES = [
        ("roio-cli ", ["--help", "--version", "ask", "attach", "bridge", "buses", "dump", "gen", "help", "hub",
                       "kind", "play", "record", "robot", "send", "top"]),
        ("roio-cli d", ["dump"]),
        ("roio-cli send --cl", ["--class"]),
        ("roio-cli send --wait lo", ["local:robot"]),
        ("roio-cli help b", ["bridge", "buses"]),
        ("roio-cli hub ", ["local:robot"]),
        ("roio-cli hub --bit", ["--bitrate"]),
        ("roio-cli send --class s", ["stream", "system"]),
        ("roio-cli dump -t ", ["A", "a", "d", "z"]),
        ("roio-cli dump -n 5 lo", ["local:robot"]),
        ("roio-cli dump local:r", ["local:robot"]),
        ("roio-cli send local:robot ", []),
        ("roio-cli dump local:robot u", ["urgent"]),
        ("roio-cli dump local:robot urgent class=s", ["class=stream", "class=system"]),
        ("roio-cli dump serial:a", ["serial:auto"]),
        ("roio-cli dump -b lo", ["local:robot"]),
        ("roio-cli record -o x.log lo", ["local:robot"]),
        ("roio-cli record local:robot u", ["urgent"]),
        ("roio-cli record --f", ["--force"]),
        ("roio-cli play --speed ", ["max"]),
        ("roio-cli play x.log lo", ["local:robot"]),
        ("roio-cli buses --j", ["--json"]),
        ("roio-cli bridge s", ["set", "show"]),
        ("roio-cli kind ", ["--help", "header", "js", "md"]),
        ("roio-cli kind js --ch", ["--check"]),
        ("roio-cli robot d", ["dbc"]),
        ("roio-cli robot dbc --o", ["--output"]),
        ("roio-cli bridge show a", ["auto"]),
        ("roio-cli bridge set --mode ", ["listen", "loopback", "normal"]),
        ("roio-cli bridge set --mode listen a", ["auto"]),
        ("roio-cli bridge set auto --addr", ["--address"]),
        ("roio-cli bridge attach auto ", ["local:robot"]),
        ("roio-cli a", ["ask", "attach"]),
        ("roio-cli ask --timeout 5 lo", ["local:robot"]),
        ("roio-cli ask --class s", ["stream", "system"]),
        ("roio-cli top --bitrate 500000 lo", ["local:robot"]),
        ("roio-cli gen --to ", ["random"]),
        ("roio-cli gen --se", ["--seed"]),
        ("roio-cli gen --size 4-8 --to random --load 80% lo", ["local:robot"]),
        ("roio-cli attach lo", ["local:robot"]),
        ("roio-cli attach serial:auto lo", ["local:robot"]),
        ("roio-cli attach --v", ["--verbose"]),
    ]

    def test_bash(self):
        script = r"""
          source "$1"; line=$2
          COMP_LINE=$line COMP_POINT=${#line}
          # The words as readline cuts them: at spaces, ':' and '='.
          mapfile -t COMP_WORDS < <(grep -oE '[:=]+|[^ :=]+' <<<"$line")
          [[ $line == *' ' ]] && COMP_WORDS+=('')
          COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
          _roio_cli
          [ ${#COMPREPLY[@]} -eq 0 ] || printf '%s\n' "${COMPREPLY[@]}"
        """
        file = os.path.join(TOOL, "completions", "roio-cli.bash")
        for line, offered in self.LINES:
            with self.subTest(line):
                last = line.split(" ")[-1]
                kept = last[: max(last.rfind(":"), last.rfind("=")) + 1]
                self.assertEqual(
                    self.run_shell("bash", "--norc", "-c", script, "bash", file, line),
                    [word[len(kept):] for word in offered],
                )

    def test_fish(self):
        file = os.path.join(TOOL, "completions", "roio-cli.fish")
        self.run_shell("fish", "--no-execute", file)
        for line, offered in self.LINES:
            with self.subTest(line):
                lines = self.run_shell("fish", "--no-config", "-c",
                                       f'source {file}; complete -C "{line}"')
                words = [text.split("\t")[0] for text in lines]
                # fish offers options only after a dash
                self.assertEqual(words, [w for w in offered if line[-1] != " " or w[0] != "-"])

    def test_zsh(self):
        file = os.path.join(TOOL, "completions", "_roio-cli")
        self.run_shell("zsh", "-n", file)
        # zsh completes on a terminal of its own only; what it is given to offer goes to a file too.
        # Before its line editor is ready, the terminal itself would take the keys.
        script = r"""
          zmodload zsh/zpty
          zpty shell zsh -f -i
          zpty -w shell 'PS1='
          zpty -w shell 'fpath=('"$1"' $fpath); autoload -U compinit; compinit -u -D'
          zpty -w shell 'compadd() { if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)* ]]; then builtin compadd "$@"; return; fi; builtin compadd -A found "$@"; print -rl -- $found >> '"$3"'; builtin compadd "$@" }'
          zpty -w shell 'zle-line-init() { print -n READ""Y }; zle -N zle-line-init'
          zpty -r shell out '*READY*'
          zpty -n -w shell "$2"$'\t'$'\C-U'$'\n'"print END"$'\n'
          zpty -r shell out '*END*'
          zpty -d shell
        """
        for line, offered in self.LINES:
            with self.subTest(line):
                found = self.path("found")
                open(found, "w").close()
                subprocess.run(["zsh", "-f", "-c", script, "zsh", os.path.dirname(file), line, found],
                               capture_output=True, timeout=GUARD)
                with open(found) as file_of_found:
                    words = file_of_found.read().split()
                self.assertEqual(
                    sorted(set(words)),
                    [w for w in offered if line[-1] != " " or w[0] != "-"],
                )


if __name__ == "__main__":
    main()
