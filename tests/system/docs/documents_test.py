"""What the documents say, against what there is.

Before a block of commands, a comment may say how it is tested:
  <!-- first terminal -->, <!-- second terminal -->  the first stays while the second runs (README.md)
  <!-- not run here: WHY -->                         needs hardware, or is run by another test
Every other block of commands in the documents for users is refused, so that none goes untested; but in
those whose console blocks tests/tools/cli/docs_test.py runs.
"""

import os
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["ROIO_SOURCE"])
TOOLS = os.environ["ROIO_TOOLS"]
FOR_USERS = sorted(SOURCE.glob("docs/*.md"))
FOR_BUILDERS = [*sorted(SOURCE.glob("docs/internals/*.md")), SOURCE / "bench/figures.md"]
DOCUMENTS = [*sorted(SOURCE.glob("*.md")), *FOR_USERS, *FOR_BUILDERS]
# Their console blocks are run, by tests/tools/cli/docs_test.py.
RUN_AS_SESSIONS = [SOURCE / "docs" / name for name in ("cli.md", "python.md", "recipes.md")]
GUARD = 60  # seconds; against hanging only


def without_blocks(text):
    return re.sub(r"(?ms)^```.*?^```$", "", text)


def anchors(text):
    """The names that headings have as link targets."""
    headings = re.findall(r"(?m)^#+ (.*)$", without_blocks(text))
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def command_blocks(path):
    """Each block of commands, with the comment above it."""
    pattern = r"(?ms)^(?:<!-- ([^\n]*) -->\n)?```(?:sh|console|powershell)\n(.*?)^```$"
    return re.findall(pattern, path.read_text())


class Links(unittest.TestCase):
    def test_lead_to_files_and_headings_that_exist(self):
        for document in DOCUMENTS:
            for link in re.findall(r"\]\(([^)]+)\)", without_blocks(document.read_text())):
                if link.startswith("http"):
                    continue
                with self.subTest(document=document.name, link=link):
                    name, _, heading = link.partition("#")
                    target = document.parent / name if name else document
                    self.assertTrue(target.exists(), f"{target} does not exist")
                    if heading:
                        self.assertIn(heading, anchors(target.read_text()))


class Lists(unittest.TestCase):
    def test_dependencies_are_those_that_setup_installs(self):
        document = (SOURCE / "docs/internals/dependencies.md").read_text()
        sections = re.split(r"(?m)^## .*`scripts/setup (\w+)`$", document)[1:]
        before = []
        for purpose, section in zip(sections[::2], sections[1::2]):
            with self.subTest(purpose=purpose):
                rows = re.findall(r"(?m)^\| ([^|]*) \|", section)[2:]
                said = [name for row in rows for name in row.split(", ")]
                installed = subprocess.run([SOURCE / "scripts/setup", purpose, "--list"], check=True,
                                           capture_output=True, text=True, timeout=GUARD).stdout.split()
                self.assertEqual(sorted(before + said), sorted(installed))
                before += said
        self.assertEqual(sections[::2], ["install", "demo", "bench", "test"])

    def test_changelog_begins_with_this_version(self):
        header = (SOURCE / "libroio/core/include/roio/version.hpp").read_text()
        version = ".".join(re.findall(r"define ROIO_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header))
        first = re.search(r"(?m)^## (\S+?),? ", (SOURCE / "CHANGELOG.md").read_text())[1]
        self.assertEqual(first, version)

    def test_readme_leads_to_every_document_for_users(self):
        readme = (SOURCE / "README.md").read_text()
        for document in FOR_USERS:
            self.assertIn(f"](docs/{document.name})", readme)

    def test_contributing_leads_to_every_document_for_builders(self):
        contributing = (SOURCE / "CONTRIBUTING.md").read_text()
        for document in FOR_BUILDERS:
            self.assertIn(f"]({document.relative_to(SOURCE)})", contributing)


class Words(unittest.TestCase):
    def test_hub_is_a_command_and_no_word_for_users(self):
        for document in [SOURCE / "README.md", *FOR_USERS]:
            with self.subTest(document=document.name):
                words = re.sub(r"`[^`]*`|^## hub$|roio-cli-hub\(1\)", "", without_blocks(document.read_text()), flags=re.MULTILINE)
                self.assertNotRegex(words, r"(?i)\bhubs?\b")

    def test_nor_in_the_headers_that_they_read(self):
        for folder in ("libroio/core/include", "libroio/host/include", "firmware/arduino/src"):
            for header in (SOURCE / folder).glob("**/*.h*"):
                with self.subTest(header=header.name):
                    self.assertNotRegex(header.read_text(), r"(?i)\bhubs?\b")

    def test_sources_name_documents_that_exist(self):
        folders = ("libroio", "firmware", "bridge_usb", "sim", "tools", "tests", "bench", "examples", "cmake", "scripts")
        for file in [*(file for folder in folders for file in SOURCE.glob(f"{folder}/**/*")),
                     SOURCE / "CMakeLists.txt"]:
            if not file.is_file() or file.suffix in (".pyc", ".elf"):
                continue
            for name in re.findall(r"\b(?:docs|bench)/[\w/-]+\.md\b", file.read_text(errors="replace")):
                with self.subTest(file=str(file.relative_to(SOURCE)), name=name):
                    self.assertTrue((SOURCE / name).exists())


class Commands(unittest.TestCase):
    def test_every_block_is_run_or_says_why_not(self):
        for document in [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *FOR_USERS]:
            for how, block in command_blocks(document):
                with self.subTest(document=document.name):
                    if document not in RUN_AS_SESSIONS:
                        self.assertRegex(how, r"^(first terminal|second terminal|not run here: .+)$", block)

    def test_two_terminals(self):
        blocks = {how: block.splitlines() for how, block in command_blocks(SOURCE / "README.md")}
        listen, *expected = blocks["first terminal"]
        with tempfile.TemporaryDirectory() as folder:
            shell = {"cwd": folder, "text": True, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE,
                     "env": dict(os.environ, ROIO_RUNTIME_DIR=folder, PATH=TOOLS + ":" + os.environ["PATH"])}
            # -v says when it listens; exec, so that the signal reaches it and no shell.
            command = "exec " + listen.removeprefix("$ ").replace(" dump ", " dump -v ")
            with subprocess.Popen(["timeout", str(GUARD), "bash", "-c", command], **shell) as first:
                self.assertIn("listening", first.stderr.readline())
                for line in blocks["second terminal"]:
                    second = subprocess.run(["bash", "-c", line.removeprefix("$ ")], timeout=GUARD, **shell)
                    self.assertEqual((second.returncode, second.stdout, second.stderr), (0, "", ""))
                seen = [first.stdout.readline().rstrip("\n") for _ in expected]
                first.send_signal(signal.SIGINT)
                rest, _ = first.communicate(timeout=GUARD)
        self.assertEqual(seen, expected)
        self.assertEqual(rest, "")


if __name__ == "__main__":
    unittest.main()
