#!/usr/bin/env python3
"""Runs the console examples of documents, and compares what they print with what the documents say.

A block is one bash session: "$ " begins a command, "> " goes on with it, the rest is output. Commands
that end with "&" run until they end by themselves; what they print stands at the block's end, in their
order. One in the background that `send --wait` or `play --wait` follows is run as it stands; for others the script waits, in
place of "sleep". A block after <!-- file NAME --> is a file that the blocks after it find. Blocks that name vcan0, themselves or in a
file that they name, need real SocketCAN and are run with ROIO_CLI_ON_SOCKETCAN, the others
without. For blocks that name /dev/ttyACM0 there is a bridge on a simulated board, if there is ROIO_SIM;
the terminal's path is longer, so with them the number of spaces does not count.
"""

import os
import re
import stat
import subprocess
import sys
import tempfile

from driver import CLI, GUARD, ON_SOCKETCAN, CliTest, main, masked

WITH_BRIDGE = "ROIO_SIM" in os.environ
if WITH_BRIDGE:
    from bridge_test import start_bridge, without_repeats

DOCUMENTS = os.environ["ROIO_CLI_DOCUMENTS"].split(":")
PORT = "/dev/ttyACM0"
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(DOCUMENTS[0])), "examples")

# Stands for roio-cli in the background: says in a file when a dump, or a check, listens.
LISTENER = r"""#!/bin/bash
case "$1 $2" in
  'gen --check') shift 2; listen=(gen --check -v) ;;
  dump\ *) shift; listen=(dump -v) ;;
  *) exec "$ROIO_CLI" "$@" ;;
esac
exec 3>&1
"$ROIO_CLI" "${listen[@]}" "$@" 2>&1 >&3 3>&- | while IFS= read -r line; do
  case $line in
    *': listening') : >"$LISTENING" ;;
    *' shown, 0 lost') ;;
    *) printf '%s\n' "$line" >&2 ;;
  esac
done
exit "${PIPESTATUS[0]}"
"""


def blocks_of(document):
    """Each console block with its line, its text, and the files that stand above it."""
    with open(document) as file:
        text = file.read()
    files = {}
    for match in re.finditer(r"(?ms)^(?:<!-- file (\S+) -->\n)?```(\w+)\n(.*?)^```$", text):
        name, language, block = match.groups()
        if name:
            files[name] = block
        elif language == "console":
            line = text[: match.start()].count("\n") + 1
            whole = block + "".join(files[name] for name in files if name in block)
            if ("vcan0" in whole) == ON_SOCKETCAN:
                yield line, block, dict(files)


def split(block):
    """The commands, and the output of all of them."""
    commands, output = [], []
    for line in block.splitlines():
        if line.startswith("$ "):
            commands.append(line[2:])
        elif line.startswith("> "):
            commands[-1] += "\n" + line[2:]
        else:
            output.append(line + "\n")
    return commands, "".join(output)


# Waits until it is attached, or has failed.
ATTACH = """attach() {
  $1 >"$2" 2>&1 &
  until grep -q ": attached to " "$2" || ! kill -0 $! 2>/dev/null; do sleep 0.01; done
}"""


def session(commands):
    """The commands as a script that waits for what runs in the background, first to listen, then to end."""
    script, background = [ATTACH], 0
    commands = [command for command in commands if not command.startswith("sleep ")]
    for command, follower in zip(commands, commands[1:] + [""]):
        if " attach " in command and command.endswith("&"):
            background += 1
            script.append(f'attach "{command[:-1].strip()}" "$OUT.{background}"')
        elif command.endswith("&"):
            background += 1
            # Output that the command sends elsewhere stays there.
            if "send --wait" in follower or "play --wait" in follower:
                script.append(f'({command[:-1]}) >"$OUT.{background}" 2>&1 &')
                continue
            script.append(f'(PATH="$LISTENERS:$PATH"; {command[:-1]}) >"$OUT.{background}" 2>&1 &')
            script.append('until [ -e "$LISTENING" ]; do sleep 0.01; done; rm "$LISTENING"')
        else:
            script.append(command)
    script.append("wait")
    script += [f'cat "$OUT.{number}"' for number in range(1, background + 1)]
    return "\n".join(script)


def write_program(path, text):
    with open(path, "w") as file:
        file.write(text)
        os.fchmod(file.fileno(), stat.S_IRWXU)


class DocumentTest(CliTest):
    def test_examples_print_what_the_documents_say(self):
        programs, listeners = self.path("bin"), self.path("listeners")
        for folder in (programs, listeners):
            os.mkdir(folder)
        os.symlink(CLI, os.path.join(programs, "roio-cli"))
        write_program(os.path.join(programs, "python3"), f'#!/bin/sh\nexec {sys.executable} "$@"\n')
        write_program(os.path.join(listeners, "roio-cli"), LISTENER)
        env = dict(os.environ, PATH=programs + ":" + os.environ["PATH"], LISTENERS=listeners,
                   LISTENING=self.path("listening"), OUT=self.path("out"))
        for document in DOCUMENTS:
            for line, block, files in blocks_of(document):
                with self.subTest(document=os.path.basename(document), line=line), \
                        tempfile.TemporaryDirectory() as folder:
                    for name, text in files.items():
                        with open(os.path.join(folder, name), "w") as file:
                            file.write(text)
                    os.symlink(EXAMPLES, os.path.join(folder, "examples"))
                    self.folder = folder
                    if PORT not in block:
                        self.check(block, env)
                    elif WITH_BRIDGE:
                        self.check_with_bridge(block, env)

    def printed(self, commands, env):
        done = subprocess.run(
            ["bash", "-c", session(commands)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, timeout=GUARD, env=env, cwd=self.folder,
        )
        return masked(done.stdout)

    def check(self, block, env):
        commands, output = split(block)
        self.assertEqual(self.printed(commands, env), masked(output))

    def check_with_bridge(self, block, env):
        commands, output = split(block)
        sim, port = start_bridge(self)
        printed = self.printed([command.replace(PORT, port) for command in commands],
                               dict(env, ROIO_SERIAL_PORTS=port)).replace(port, PORT)
        sim.end()
        self.assertEqual(*(re.sub(" +", " ", without_repeats(text)) for text in (printed, output)))


if __name__ == "__main__":
    main()
