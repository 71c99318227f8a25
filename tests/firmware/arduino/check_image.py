#!/usr/bin/env python3
"""Fails when a build warned of anything that is not Arduino's own: usage: check_image.py ELF HARDWARE"""
import pathlib
import re
import sys

image = pathlib.Path(sys.argv[1])
hardware = sys.argv[2]
if not image.exists():
    sys.exit(f"{image} is not there: it was not built, or does not build")
if not image.read_bytes().startswith(b"\x7fELF"):
    sys.exit(f"{image} is not an ELF image")
warnings = [line for line in image.with_suffix(".log").read_text().splitlines()
            if re.search("warning:", line, re.IGNORECASE) and not line.startswith(hardware)]
if warnings:
    sys.exit("\n".join(warnings))
