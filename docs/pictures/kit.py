"""The look that all pictures share, and the few shapes that they are made of.

A picture is a card with a background of its own: it stays legible on any page, whether the page's colours
follow the reader's light or dark mode or not. Positions of shapes are multiples of 4 px; the kit insists.
"""

import re
from xml.sax.saxutils import escape

# One accent colour; everything else is grey. Each text colour has a contrast of 4.5 : 1 or more on every
# ground that text may stand on (tests/system/docs/pictures_test.py computes it).
LIGHT = {"card": "#ffffff", "fill": "#f1f4f7", "tint": "#e3effc", "edge": "#c3ccd6",
         "ink": "#1b2027", "muted": "#525d6a", "accent": "#0a5fbe"}
DARK = {"card": "#14181d", "fill": "#20262e", "tint": "#17304d", "edge": "#46515d",
        "ink": "#e8ecf0", "muted": "#a7b1bc", "accent": "#74b6ff"}
TEXT_COLOURS = ("ink", "muted", "accent")
GROUNDS = ("card", "fill", "tint")

SANS = "system-ui,-apple-system,'Segoe UI',Roboto,'Noto Sans','DejaVu Sans',sans-serif"
MONO = "ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono',monospace"
STEP = 4

RULES = f"""
text{{font:14px {SANS};fill:var(--ink)}}
.mono{{font-family:{MONO}}} .bold{{font-weight:600}} .small{{font-size:12px}} .big{{font-size:16px}}
.muted{{fill:var(--muted)}} .accent{{fill:var(--accent)}} .on-accent{{fill:var(--card)}}
.card{{fill:var(--card);stroke:var(--edge)}} .fill{{fill:var(--fill);stroke:var(--edge)}}
.tint{{fill:var(--tint);stroke:var(--accent)}} .solid{{fill:var(--accent)}} .dark{{fill:var(--ink)}}
.open{{fill:var(--card);stroke:var(--ink);stroke-width:1.5}} .hole{{fill:var(--card)}}
.line,.halo{{fill:none;stroke-linecap:round;stroke-linejoin:round}}
.line{{stroke:var(--ink);stroke-width:2}} .halo{{stroke:var(--card);stroke-width:8;stroke-linecap:butt}}
.line.thin{{stroke:var(--muted);stroke-width:1}} .line.hot{{stroke:var(--accent)}}
.line.dashed{{stroke-dasharray:6 4}} .frame{{fill:none;stroke:var(--edge)}}
"""


def coloured(rules, palette):
    """The rules with a palette's colours in them. (Not left to CSS: what is no browser does not know var().)"""
    return re.sub(r"var\(--(\w+)\)", lambda name: palette[name[1]], rules)


def in_dark(rules):
    """Of the rules those that name a colour, in dark mode's."""
    return coloured("".join(re.findall(r"[^{}]+\{[^{}]*var\(--[^{}]*\}", rules)), DARK)


def number(value):
    return f"{value:.2f}".rstrip("0").rstrip(".")


def path(points):
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points)


def toward(start, end, distance):
    """The point so far from start on the level or upright way to end."""
    return tuple(a + (distance if b > a else -distance if b < a else 0) for a, b in zip(start, end))


def on_grid(*values):
    for value in values:
        if value % STEP:
            raise ValueError(f"expected a multiple of {STEP} px; got {value}")


class Picture:
    """Collects elements; str() is the SVG."""

    def __init__(self, width, height, title, description, rules=""):
        on_grid(width, height)
        self.width, self.height = width, height
        self.title, self.description, self.rules = title, description, rules
        self.parts = []

    def raw(self, element):
        self.parts.append(element)

    def text(self, x, y, words, style="", anchor="start"):
        """One line; y is its middle, so that a text stands in a box by the box's middle."""
        size = 12 if "small" in style.split() else 16 if "big" in style.split() else 14
        attributes = f' class="{style}"' if style else ""
        if anchor != "start":
            attributes += f' text-anchor="{anchor}"'
        self.raw(f'<text x="{number(x)}" y="{number(y + 0.36 * size)}"{attributes}>{escape(words)}</text>')

    def lines(self, x, y, rows, style="", anchor="start", step=20):
        """Several lines, the first one's middle at y. A row is a text, or a text and its own style."""
        for row, words in enumerate(rows):
            words, own = words if isinstance(words, tuple) else (words, style)
            self.text(x, y + row * step, words, own, anchor)

    def box(self, x, y, width, height, style="fill", radius=8):
        on_grid(x, y, width, height)
        # Half a pixel, so that an edge of one pixel is one pixel.
        self.raw(f'<rect x="{x + 0.5}" y="{y + 0.5}" width="{width - 1}" height="{height - 1}" '
                 f'rx="{radius}" class="{style}"/>')

    def bar(self, x, y, width, height, style="solid", radius=4):
        on_grid(x, y, width, height)
        self.raw(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}" class="{style}"/>')

    def titled(self, x, y, width, height, name, rows=(), style="fill", name_style="bold"):
        """A box with a name and lines below it, all in its middle."""
        self.box(x, y, width, height, style)
        middle, top = x + width / 2, y + height / 2 - 10 * len(rows)
        self.lines(middle, top, [(name, name_style), *[(row, "small muted") for row in rows]], anchor="middle")

    def line(self, points, style="", halo=None):
        """A line through points; with a halo, what it crosses is seen to pass below it.

        The halo keeps off both ends by so many pixels: there a line joins something and crosses nothing.
        """
        on_grid(*[value for point in points for value in point])
        if halo is not None:
            inner = [toward(points[0], points[1], halo), *points[1:-1], toward(points[-1], points[-2], halo)]
            self.raw(f'<path d="{path(inner)}" class="halo"/>')
        self.raw(f'<path d="{path(points)}" class="{("line " + style).strip()}"/>')

    def dot(self, x, y, style="dark", radius=4):
        on_grid(x, y)
        self.raw(f'<circle cx="{x}" cy="{y}" r="{radius}" class="{style}"/>')

    def arrow(self, points, style="", both=False):
        """A line with a head at its end, or at both ends. The last stretch is level or upright."""
        self.line(points, style)
        for (x, y), (from_x, from_y) in [(points[-1], points[-2])] + ([(points[0], points[1])] if both else []):
            across, along = ((0, 1) if x > from_x else (0, -1)) if y == from_y else ((1, 1) if y > from_y else (1, -1))
            back = -8 * along
            head = (f"M{x + back} {y - 5}L{x} {y}L{x + back} {y + 5}" if not across
                    else f"M{x - 5} {y + back}L{x} {y}L{x + 5} {y + back}")
            self.raw(f'<path d="{head}" class="{("line " + style.replace("dashed", "")).strip()}"/>')

    def measure(self, start, end):
        """A dimension line, with a stop at each end."""
        self.line([start, end], "thin")
        for x, y in (start, end):
            self.line([(x, y - 4), (x, y + 4)] if start[1] == end[1] else [(x - 4, y), (x + 4, y)], "thin")

    def resistor(self, x, y, length, upright, style="open"):
        """A resistor's body of 24 px in the middle of a line of that length, which begins at (x, y)."""
        on_grid(x, y, length)
        self.line([(x, y), (x, y + length) if upright else (x + length, y)])
        middle = length // 2
        if upright:
            self.raw(f'<rect x="{x - 6}" y="{y + middle - 12}" width="12" height="24" class="{style}"/>')
        else:
            self.raw(f'<rect x="{x + middle - 12}" y="{y - 6}" width="24" height="12" class="{style}"/>')

    def __str__(self):
        rules = RULES + self.rules + "\n"
        head = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" height="{self.height}" '
            f'viewBox="0 0 {self.width} {self.height}" role="img" aria-labelledby="title desc">',
            f'<title id="title">{escape(self.title)}</title>',
            f'<desc id="desc">{escape(self.description)}</desc>',
            "<!-- made by docs/pictures/draw.py: change that, not this -->",
            f"<style>{coloured(rules, LIGHT)}@media(prefers-color-scheme:dark){{{in_dark(rules)}}}</style>",
            f'<rect x="0.5" y="0.5" width="{self.width - 1}" height="{self.height - 1}" rx="12" class="card"/>',
        ]
        return "\n".join([*head, *self.parts, "</svg>"]) + "\n"
