"""The recording of scripts/demo, demo.cast, as a terminal that scrolls. Without animation it shows the end."""

import json
import pathlib

from kit import Picture, number
from xml.sax.saxutils import escape

CAST = pathlib.Path(__file__).resolve().parent / "demo.cast"
ADVANCE, LEADING = 8, 20  # px a character and a line
TOP, MARGIN = 56, 32
READING_S, LAST_S = 0.45, 8  # a line stands so long at least; then the end


def recorded():
    """[(seconds, line)] as a terminal of the recorded width breaks them, and the header."""
    header, *events = [json.loads(row) for row in CAST.read_text(encoding="utf-8").splitlines()]
    rows = []
    for when, kind, data in events:
        if kind != "o" or not data.endswith("\r\n") or "\x1b" in data:
            raise ValueError(f"expected whole lines without control sequences in {CAST.name}; got {data!r}")
        for line in data.split("\r\n")[:-1]:
            width = header["width"]
            pieces = [line[at:at + width] for at in range(0, len(line), width)] or [""]
            rows += [(when, piece, line) for piece in pieces]
    return header, rows


def paced(rows):
    """When each row appears: as recorded, but no faster than one can read, and a broken line at once."""
    times, now, before = [], 0.0, None
    for when, _, line in rows:
        if before is not None and line is not before:
            now = max(when, now + (READING_S if line else 0))
        times.append(now)
        before = line
    return times


def style(line):
    if line.lstrip().startswith("$ "):
        return "mono bold accent"
    return "mono" if line.startswith(" ") else "mono bold"


def steps(times, end, values, unit="px"):
    """Keyframes that jump to each value at its time."""
    frames, last = [], None
    for when, value in zip(times, values):
        if value != last:
            frames.append((when / end * 100, value))
        last = value
    return "".join(f"{number(at)}%{{transform:translateY({value}{unit})}}" for at, value in frames) + \
        f"100%{{transform:translateY({last}{unit})}}"


def picture():
    header, rows = recorded()
    times = paced(rows)
    end = times[-1] + LAST_S
    window = header["height"] * LEADING
    width = header["width"] * ADVANCE + 2 * MARGIN
    scrolled = [-max(0, (row + 1) * LEADING - window) for row in range(len(rows))]
    covered = [(row + 1) * LEADING for row in range(len(rows))]
    rules = (f"@media(prefers-reduced-motion:no-preference){{"
             f".scroll{{animation:scroll {number(end)}s step-end infinite}}"
             f".cover{{animation:cover {number(end)}s step-end infinite}}}}"
             f"@keyframes scroll{{{steps(times, end, scrolled)}}}"
             f"@keyframes cover{{{steps(times, end, covered)}}}"
             f".scroll{{transform:translateY({scrolled[-1]}px)}} .cover{{transform:translateY({covered[-1]}px)}}"
             f".blank{{fill:var(--card)}} pre,text{{white-space:pre}}")
    p = Picture(width, TOP + window + 24, "A recording of scripts/demo",
                "Three simulated Arduinos run the firmware that would be flashed to them, on one bus: a bridge, a servo arm "
                "and a sensor board. roio-cli talks with them over the bridge: the arm moves, a button is seen, and a "
                "message that is wrong is refused and counted.", rules)
    for column in range(3):
        p.dot(MARGIN + 4 + 20 * column, 28, "edge-dot", 6)
    p.rules += ".edge-dot{fill:var(--edge)}"
    p.text(width / 2, 28, "scripts/demo", "small muted mono", "middle")
    p.line([(0, 48), (width, 48)], "edge-line")
    p.rules += ".line.edge-line{stroke:var(--edge);stroke-width:1}"
    p.raw(f'<svg x="{MARGIN}" y="{TOP}" width="{width - 2 * MARGIN}" height="{window}"><g class="scroll">')
    for row, (_, piece, line) in enumerate(rows):
        if piece.strip():
            text = piece.lstrip(" ")
            left = (len(piece) - len(text)) * ADVANCE
            p.raw(f'<text x="{left}" y="{row * LEADING + 15}" textLength="{len(text) * ADVANCE}" '
                  f'lengthAdjust="spacingAndGlyphs" class="{style(line)}">{escape(text)}</text>')
    p.raw(f'<rect class="blank cover" width="100%" height="{len(rows) * LEADING}"/></g></svg>')
    return p
