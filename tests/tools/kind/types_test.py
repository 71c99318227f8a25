"""The types of an ES module, as TypeScript reads them: right in themselves, and wrong use is an error.

ROIO_CLI makes the module, TSC is TypeScript's compiler.
"""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

GUARD = 100  # seconds
FILES = pathlib.Path(__file__).with_name("types")


class Types(unittest.TestCase):
    def test_module_and_its_use(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            shutil.copytree(FILES, folder, dirs_exist_ok=True)
            subprocess.run([os.environ["ROIO_CLI"], "kind", "js", "-o", folder / "everything.js",
                            folder / "everything.kind.json"], check=True, timeout=GUARD)
            done = subprocess.run([os.environ["TSC"], "-p", folder], capture_output=True, text=True, timeout=GUARD)
            self.assertEqual((done.stdout, done.stderr, done.returncode), ("", "", 0))


if __name__ == "__main__":
    unittest.main(verbosity=2)
