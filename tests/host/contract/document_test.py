"""docs/backend.md shows the files of examples/backend as they are: document_test.py SOURCE_FOLDER.

A block of code that follows a link to such a file is that file, whole, or a part of it that begins and
ends with whole lines.
"""
import re
import sys
from pathlib import Path

source = Path(sys.argv[1])
text = (source / "docs/backend.md").read_text()
shown = re.findall(r"\]\(\.\./(examples/backend/[\w.]+)\):\n\n```\w+\n(.*?)```\n", text, re.DOTALL)
whole = set()
for name, block in shown:
    code = (source / name).read_text()
    if "\n" + block not in "\n" + code:
        sys.exit(f"docs/backend.md shows {name} otherwise than it is:\n{block}")
    if block == code:
        whole.add(name)
for name in ("memory_bus.hpp", "memory_bus.cpp", "contract_backends.cpp", "CMakeLists.txt"):
    if f"examples/backend/{name}" not in whole:
        sys.exit(f"docs/backend.md does not show examples/backend/{name}, whole; it shows {sorted(whole)}")
